#include "sources/keras_h5.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/network/network_shape.h"
#include "sources/hdf5_handles.h"
#include "sources/hdf5_texts.h"
#include "sources/keras_archive.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "HDF5 files are little-endian");

constexpr std::uint64_t kFreeBlock = 16;  // bytes of a local heap's smallest free block
constexpr std::size_t kMaxLinks = 4096;   // of a group; groups of a file
constexpr int kMaxDepth = 6;              // of groups in groups
constexpr std::string_view kExpected =
    "expected dense layers of Keras, each with a kernel and a bias";

using Handle = Hdf5Handle;

[[noreturn]] void FailDamaged(const std::string& place) {
  Fail(place, ": truncated or damaged HDF5 file (", Hdf5Reason(), "); copy it again");
}

std::uint64_t LoadUint64(std::string_view bytes, std::size_t at) {
  std::uint64_t value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

// Whether the local heap at `heap` has a free list that is circular: "HEAP", 4 bytes, then the
// data segment's size, the offset of the first free block in it, and its address. A free block
// begins with the offset of the next one (1: none) and its own size. Counts down *blocks_left.
bool FreeListIsCircular(std::string_view bytes, std::size_t heap, std::uint64_t* blocks_left) {
  constexpr std::uint64_t kEnd = 1, kHeader = 32;
  if (bytes.size() - heap < kHeader) return false;
  const std::uint64_t segment = LoadUint64(bytes, heap + 24);
  if (segment > bytes.size()) return false;
  const std::uint64_t size = std::min(LoadUint64(bytes, heap + 8), bytes.size() - segment);
  std::uint64_t block = LoadUint64(bytes, heap + 16);
  while (block != kEnd) {
    if (size < kFreeBlock || block > size - kFreeBlock) return false;  // HDF5 reports this itself
    if (*blocks_left == 0) return true;
    --*blocks_left;
    block = LoadUint64(bytes, segment + block);
  }
  return false;
}

// Throws Error if a free list is circular: HDF5 up to version 1.10 follows it until memory runs out.
// (The heaps hold the names in groups.)
void CheckHeaps(const std::string& path, std::string_view bytes) {
  constexpr std::string_view kHeap = "HEAP";
  std::uint64_t blocks_left = bytes.size() / kFreeBlock;  // in all heaps together
  for (std::size_t at = bytes.find(kHeap); at != bytes.npos; at = bytes.find(kHeap, at + 1)) {
    if (FreeListIsCircular(bytes, at, &blocks_left)) {
      Fail(path, ": damaged HDF5 file (the heap at byte ", at, " runs in a circle); copy it again");
    }
  }
}

// Throws Error unless the file begins like one of HDF5 with addresses and lengths of 8 bytes, the
// only ones that Keras writes and CheckHeaps looks through.
void CheckSuperblock(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kSizesAt[] = {13, 13, 9, 9};  // by the superblock's version
  if (!bytes.starts_with(kHdf5Magic)) {
    Fail(path, ": not an HDF5 file; expected a network that Keras saved");
  }
  const std::size_t version = bytes.size() < 16 ? ~0u : static_cast<unsigned char>(bytes[8]);
  if (version >= std::size(kSizesAt) || bytes[kSizesAt[version]] != 8 ||
      bytes[kSizesAt[version] + 1] != 8) {
    Fail(path, ": truncated or damaged HDF5 file (its first bytes); copy it again");
  }
}

// Access to `bytes` as a file, for H5Fopen: it then reads nothing from disk.
Handle ImageAccess(std::string bytes) {
  constexpr std::size_t kIncrement = 1 << 16;
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.get(), kIncrement, /*backing_store=*/false);
  H5Pset_file_image(access.get(), bytes.data(), bytes.size());
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  return access;
}

// Whether `group` has `name` as a link within the file; soft and external links don't count.
bool Has(const std::string& place, const Handle& group, const std::string& name) {
  const htri_t exists = H5Lexists(group.get(), name.c_str(), H5P_DEFAULT);
  if (exists < 0) FailDamaged(place);
  H5L_info_t info;
  if (exists == 0) return false;
  if (H5Lget_info(group.get(), name.c_str(), &info, H5P_DEFAULT) < 0) FailDamaged(place);
  return info.type == H5L_TYPE_HARD;
}

Handle OpenObject(const std::string& place, const Handle& group, const std::string& name,
                  H5I_type_t type) {
  if (!Has(place, group, name)) {
    Fail(place, " is missing; ", kExpected);
  }
  Handle object(H5Oopen(group.get(), name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object) FailDamaged(place);
  if (H5Iget_type(object.get()) != type) {
    Fail(place, " is not a ", type == H5I_GROUP ? "group" : "dataset",
         "; save it from Keras again");
  }
  return object;
}

// Bytes of an element. Throws Error unless it is an IEEE float of 4 or 8 bytes.
std::size_t ElementSize(const std::string& place, const Handle& dataset) {
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!type) FailDamaged(place);
  for (hid_t known : {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE}) {
    if (H5Tequal(type.get(), known) > 0) return H5Tget_size(known);
  }
  Fail(place, " is not of type float32 or float64; save it as float32");
}

// Throws Error unless the elements lie in one piece within the file. Compressed chunks could need far
// more memory than the file's size, and other files must not be read.
void CheckStorage(const std::string& place, const Handle& dataset) {
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  if (!creation) FailDamaged(place);
  if (H5Pget_layout(creation.get()) != H5D_CONTIGUOUS ||
      H5Pget_external_count(creation.get()) != 0) {
    Fail(place, " is not stored contiguously; convert the file: h5repack -f NONE -l CONTI IN OUT");
  }
}

std::vector<std::int64_t> Shape(const std::string& place, const Handle& dataset) {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  if (!space) FailDamaged(place);
  if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) return {0};
  std::array<hsize_t, H5S_MAX_RANK> extents;
  const int rank = H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  if (rank < 0) FailDamaged(place);
  return {extents.begin(), extents.begin() + rank};
}

Tensor ReadDataset(const std::string& place, const Handle& group, const std::string& name,
                   std::size_t file_size) {
  const Handle dataset = OpenObject(place, group, name, H5I_DATASET);
  const std::size_t size = ElementSize(place, dataset);
  CheckStorage(place, dataset);
  Tensor tensor;
  tensor.shape = Shape(place, dataset);
  const std::uint64_t count = ElementCount(tensor.shape, file_size / size);
  if (count == 0 || H5Dget_storage_size(dataset.get()) != count * size) {
    Fail(place, ": its shape, ", ShapeText(tensor.shape), ", doesn't fit its data; copy it again");
  }
  tensor.values.resize(count);
  if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
              tensor.values.data()) < 0) {
    FailDamaged(place);
  }
  return tensor;
}

// The links of a group to objects of its file.
std::vector<std::string> LinksOf(const std::string& place, const Handle& group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t* info, void* list) -> herr_t {
    auto* found = static_cast<std::vector<std::string>*>(list);
    if (info->type == H5L_TYPE_HARD) found->emplace_back(name);
    return found->size() > kMaxLinks ? -1 : 0;
  };
  if (H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names) < 0) {
    FailDamaged(place);
  }
  return names;
}

// "dense_12" as "dense" and 12, "dense" as that and 0: Keras counts layers of a kind.
std::pair<std::string, unsigned long> WithNumber(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  std::string kind = name.substr(0, end);
  if (kind.ends_with("_")) kind.pop_back();
  return {kind, end < name.size() ? std::strtoul(name.c_str() + end, nullptr, 10) : 0};
}

// Which of the names there is.
std::optional<std::string> OneOf(const std::vector<std::string>& links,
                                 std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (std::find(links.begin(), links.end(), name) != links.end()) return name;
  }
  return std::nullopt;
}

// Finds the layers of a file: groups, however deep, with a kernel and a bias.
class LayerFinder {
 public:
  LayerFinder(const std::string& path, std::string_view bytes)
      : path_(path), size_(bytes.size()), listed_(TextsOfAttribute(bytes, "layer_names")) {}

  void Visit(const std::string& name, const Handle& group, int depth) {
    if (++visits_ > kMaxLinks) Fail(path_, ": more groups than a Keras file has");
    const std::vector<std::string> links = LinksOf(path_, group);
    if (const auto kernel = OneOf(links, {"kernel:0", "kernel", "0"})) {
      return Read(name, group, *kernel, OneOf(links, {"bias:0", "bias", "1"}).value_or("bias:0"));
    }
    if (depth == 0) return;
    std::string kind;  // of the layers below, where no list puts them in order
    for (const auto& [child, listed] : InOrder(links)) {
      const Handle object(H5Oopen(group.get(), child.c_str(), H5P_DEFAULT), H5Oclose);
      if (!object) FailDamaged(path_);
      if (H5Iget_type(object.get()) != H5I_GROUP) {
        Fail(path_, ": dataset ", name, "/", child,
             " isn't a dense layer's kernel or bias; networks of other layers aren't read");
      }
      const std::size_t before = layers.size();
      Visit(StrCat(name, "/", child), object, depth - 1);
      if (layers.size() == before || listed) continue;
      const std::string this_kind = WithNumber(child).first;
      if (!kind.empty() && kind != this_kind) {
        Fail(path_, ": layers ", kind, " and ", this_kind, ", and no list layer_names says ",
             "which is the first");
      }
      kind = this_kind;
    }
  }

  std::vector<KerasDenseLayer> layers;

 private:
  // Those that the file lists, in its order, and that they are; if there are none, all, by number.
  std::vector<std::pair<std::string, bool>> InOrder(std::vector<std::string> links) const {
    std::vector<std::pair<std::string, bool>> order;
    for (const std::string& name : listed_) {
      if (OneOf(links, {name.c_str()})) order.emplace_back(name, true);
    }
    if (!order.empty()) return order;
    std::sort(links.begin(), links.end(), [](const std::string& a, const std::string& b) {
      return WithNumber(a) < WithNumber(b);
    });
    for (std::string& name : links) order.emplace_back(std::move(name), false);
    return order;
  }

  void Read(const std::string& name, const Handle& group, const std::string& kernel,
            const std::string& bias) {
    if (layers.size() == NetworkShape::kMaxLayers) Fail(path_, ": more layers than are read");
    const auto read = [&](const std::string& dataset) {
      return ReadDataset(StrCat(path_, ": dataset ", name, "/", dataset), group, dataset, size_);
    };
    layers.push_back({name, read(kernel), read(bias), kernel, bias});
  }

  const std::string& path_;
  std::size_t size_, visits_ = 0;
  std::vector<std::string> listed_;
};

// Where the layers are: in a whole model, in weights of Keras 3, in weights of Keras 2.
std::string LayersGroup(const std::string& path, const Handle& file) {
  for (const char* name : {"model_weights", "layers"}) {
    if (Has(path, file, name)) return name;
  }
  return ".";
}

}  // namespace

std::vector<KerasDenseLayer> ReadKerasDenseLayers(const std::string& path) {
  std::string bytes = ReadFile(path, kMaxWeightFileSize);
  if (bytes.starts_with(kZipMagic)) bytes = WeightsInArchive(path, bytes);
  CheckSuperblock(path, bytes);
  CheckHeaps(path, bytes);
  const Hdf5Turn turn;
  const Handle access = ImageAccess(bytes);
  // HDF5 wants a name that no file can have: a regular file has no files below it.
  const std::string image = path + "/image";
  const Handle file(H5Fopen(image.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file) FailDamaged(path);
  const std::string name = LayersGroup(path, file);
  const Handle group(H5Oopen(file.get(), name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!group) FailDamaged(path);
  LayerFinder finder(path, bytes);
  if (H5Iget_type(group.get()) == H5I_GROUP) {
    finder.Visit(name == "." ? "" : "/" + name, group, kMaxDepth);
  }
  if (finder.layers.empty()) Fail(path, ": ", kExpected);
  return std::move(finder.layers);
}

}  // namespace pbnbrdf
