#include "pbnbrdf/sources/nbrdf_files.h"

#include <hdf5.h>

#include <cstdlib>
#include <cstring>
#include <map>

#include "base/text.h"
#include "network/tensor.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/archive_writer.h"
#include "sources/npy_writer.h"

// For the sanitizers: HDF5 asks for as much memory as a damaged file says, copes with getting none,
// and doesn't give all of it back.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// Damaged files may keep HDF5 from closing at the end of the program, and it would say so.
[[maybe_unused]] const herr_t kNothingAtExit = H5dont_atexit();

struct Array {
  std::vector<hsize_t> shape;
  std::vector<double> values;
};

// A network's arrays by name: "fc1" (in x out), "b1" (out), "fc2", ...
using Arrays = std::map<std::string, Array>;

// Numbers that float32 holds. sizes: of all layers, e.g. {6, 21, 21, 3}.
Arrays RandomArrays(const std::vector<hsize_t>& sizes, unsigned seed) {
  const auto random = [&](std::size_t count) {
    std::vector<double> values = RandomNumbers(count, -1.0, 1.0, ++seed);
    for (double& value : values) value = static_cast<float>(value);
    return values;
  };
  Arrays arrays;
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const hsize_t in = sizes[k - 1], out = sizes[k];
    arrays[StrCat("fc", k)] = {{in, out}, random(in * out)};
    arrays[StrCat("b", k)] = {{out}, random(out)};
  }
  return arrays;
}

// "fc1" -> "/dense_1/dense_1/kernel:0"
std::string DatasetName(const std::string& name) {
  const std::string group = StrCat("/dense_", name.back());
  return group + group + (name.starts_with("fc") ? "/kernel:0" : "/bias:0");
}

// An HDF5 file in the making; closed when it goes.
class H5Writer {
 public:
  explicit H5Writer(const std::string& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)),
        links_(H5Pcreate(H5P_LINK_CREATE)) {
    H5Pset_create_intermediate_group(links_, 1);
  }
  ~H5Writer() {
    H5Pclose(links_);
    H5Fclose(file_);
  }

  void Add(const std::string& name, const Array& array, hid_t type = H5T_IEEE_F32LE,
           hid_t creation = H5P_DEFAULT) {
    const int rank = static_cast<int>(array.shape.size());
    const hid_t space = H5Screate_simple(rank, array.shape.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, links_, creation, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data());
    H5Dclose(set);
    H5Sclose(space);
  }

  hid_t file() const { return file_; }
  hid_t links() const { return links_; }

 private:
  hid_t file_, links_;
};

void WriteKeras(const std::string& path, const Arrays& arrays, hid_t type = H5T_IEEE_F32LE) {
  H5Writer file(path);
  for (const auto& [name, array] : arrays) file.Add(DatasetName(name), array, type);
}

std::string FileBytes(const std::string& path) {
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  return bytes;
}

template <typename T>
void WriteNpy(const std::string& base, const Arrays& arrays) {
  for (const auto& [name, array] : arrays) {
    std::string shape;
    for (hsize_t extent : array.shape) shape += StrCat(extent, ",");
    WriteBytes(
        StrCat(base, name, ".npy"),
        NpyBytes(NpyHeader(sizeof(T) == 4 ? "<f4" : "<f8", shape), ElementBytes<T>(array.values)));
  }
}

// The published formula, written out.
Rgb Formula(const Arrays& arrays, const RusinkiewiczAngles& a) {
  std::vector<double> x = {std::sin(a.theta_h),
                           0.0,
                           std::cos(a.theta_h),
                           std::sin(a.theta_d) * std::cos(a.phi_d),
                           std::sin(a.theta_d) * std::sin(a.phi_d),
                           std::cos(a.theta_d)};
  const std::size_t layers = arrays.size() / 2;
  for (std::size_t k = 1; k <= layers; ++k) {
    const Array& kernel = arrays.at(StrCat("fc", k));
    std::vector<double> y = arrays.at(StrCat("b", k)).values;
    for (std::size_t j = 0; j < y.size(); ++j) {
      for (std::size_t i = 0; i < x.size(); ++i) y[j] += x[i] * kernel.values[i * y.size() + j];
      if (k < layers) y[j] = std::max(y[j], 0.0);
    }
    x = y;
  }
  Rgb rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(std::exp(x[c]) - 1.0, 0.0);
  return rgb;
}

Rgb ValueAt(const Brdf& brdf, const RusinkiewiczAngles& angles) {
  const DirectionPair pair = FromAngles(angles);
  Rgb value;
  brdf.EvaluateUnclipped({&pair, 1}, {&value, 1});
  return value;
}

TEST(NbrdfFiles, KerasNetworksFollowThePublishedFormula) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  for (const std::vector<hsize_t>& sizes :
       {std::vector<hsize_t>{6, 21, 21, 3}, {6, 5, 3}, {6, 4, 9, 7, 3}}) {
    const Arrays arrays = RandomArrays(sizes, /*seed=*/1);
    for (hid_t type : {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE}) {
      WriteKeras(path, arrays, type);
      const std::unique_ptr<Brdf> brdf = OpenBrdf(path);
      const std::vector<double> angles = RandomNumbers(300, 0.0, 1.5, /*seed=*/2);
      for (std::size_t n = 0; n < angles.size(); n += 3) {
        const RusinkiewiczAngles at = {angles[n], angles[n + 1], 4.0 * angles[n + 2]};
        const Rgb value = ValueAt(*brdf, at), expected = Formula(arrays, at);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(value[c], expected[c], 1e-11 * (1.0 + expected[c]));
        }
      }
    }
  }
}

TEST(NbrdfFiles, NumPyAndKerasFilesGiveTheSameNetwork) {
  TemporaryFolder folder;
  const Arrays arrays = RandomArrays({6, 8, 5, 3}, /*seed=*/3);
  WriteKeras(folder / "x.hdf5", arrays);
  const NeuralBrdf keras = ReadNbrdf(folder / "x.hdf5");
  EXPECT_EQ(keras.shape().Description(), "6-8-5-3 relu");
  EXPECT_EQ(keras.metadata().at("encoding"), "cartesian");
  EXPECT_EQ(keras.metadata().at("origin"), "NBRDF, Keras file");
  WriteNpy<float>(folder / "a_", arrays);
  EXPECT_EQ(ReadNbrdf(folder / "a_fc1.npy").weights(), keras.weights());
  WriteNpy<double>(folder / "", arrays);
  EXPECT_EQ(OpenNetwork(folder / "fc1.npy").weights(), keras.weights());
}

TEST(NbrdfFiles, NetworksThatDontFitTogetherAreNamed) {
  TemporaryFolder folder;
  const Arrays good = RandomArrays({6, 4, 5, 3}, /*seed=*/4);
  const auto keras = [&](auto change) {
    Arrays arrays = good;
    change(arrays);
    WriteKeras(folder / "x.h5", arrays);
    return ErrorOf([&] { OpenBrdf(folder / "x.h5"); });
  };
  EXPECT_EQ(keras([](auto&) {}), "");
  EXPECT_THAT(keras([](auto& a) { a.erase("b2"); }),
              HasSubstr("x.h5: dataset /dense_2/dense_2/bias:0 is missing; expected dense layers"));
  EXPECT_THAT(keras([](auto& a) { a.erase("fc1"), a.erase("b1"); }),
              HasSubstr("/dense_2/dense_2/kernel:0: shape 4 x 5, expected 6 x units"));
  EXPECT_THAT(
      keras([](auto& a) { a.erase("fc3"), a.erase("b3"); }),
      HasSubstr("/dense_2/dense_2/kernel:0: shape 4 x 5, expected 4 x 3, the last layer's"));
  EXPECT_THAT(keras([](auto& a) {
                a["fc1"].shape = {4, 6};
              }),
              HasSubstr("kernel:0: shape 4 x 6, expected 6 x units; kernels are inputs x outputs"));
  EXPECT_THAT(keras([](auto& a) { a["b2"] = a["b1"]; }),
              HasSubstr("/dense_2/dense_2/bias:0: shape 4, expected 5"));
  EXPECT_THAT(keras([](auto& a) { a["b2"].shape = {}; }), HasSubstr("bias:0: shape a scalar"));
  EXPECT_THAT(
      keras([](auto& a) { a["fc2"].values[3] = std::nan(""); }),
      HasSubstr("x.h5: dataset /dense_2/dense_2/kernel:0: holds a value that is not finite"));
  EXPECT_THAT(keras([](auto& a) {
                a = RandomArrays({6, 300, 3}, 1);
              }),
              HasSubstr("x.h5: hidden: a layer of 300 units; must be 1 to 256"));
  EXPECT_THAT(keras([](auto& a) { a = RandomArrays({6, 3}, 1); }), HasSubstr("hidden: 0 layers"));

  WriteNpy<float>(folder / "a_", good);
  std::filesystem::remove(folder / "a_b3.npy");
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(folder / "a_fc1.npy"); }),
              HasSubstr("a_b3.npy: no such file"));
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(folder / "a_fc2.npy"); }),
              HasSubstr("a_fc2.npy: name the first layer's file, ...fc1.npy"));
}

// The names as an attribute of a group; each of `length` bytes, or H5T_VARIABLE.
void AddNames(hid_t file, const std::string& group_name, std::vector<std::string> names,
              std::size_t length) {
  std::string fixed;
  std::vector<const char*> variable;
  for (std::string& name : names) {
    if (length != H5T_VARIABLE) name.resize(length);
    fixed += name;
    variable.push_back(name.c_str());
  }
  const hid_t type = H5Tcopy(H5T_C_S1), group = H5Gopen2(file, group_name.c_str(), H5P_DEFAULT);
  H5Tset_size(type, length);
  const hsize_t count = names.size();
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(group, "layer_names", type, space, H5P_DEFAULT, H5P_DEFAULT);
  const void* data = fixed.data();
  if (length == H5T_VARIABLE) data = variable.data();
  H5Awrite(attribute, type, data);
  H5Aclose(attribute), H5Sclose(space), H5Gclose(group), H5Tclose(type);
}

// A network's layers as groups of other names, which stand in order; length: of their list, 0 for none.
void WriteLayers(const std::string& path, const Arrays& arrays, const std::string& parent,
                 const std::vector<std::string>& names, const std::string& kernel,
                 const std::string& bias, std::size_t length) {
  H5Writer file(path);
  for (std::size_t k = 0; k < names.size(); ++k) {
    file.Add(parent + names[k] + kernel, arrays.at(StrCat("fc", k + 1)));
    file.Add(parent + names[k] + bias, arrays.at(StrCat("b", k + 1)));
  }
  if (length > 0) AddNames(file.file(), parent, names, length);
}

TEST(NbrdfFiles, LayersAreFoundWhateverTheirNames) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  const Arrays arrays = RandomArrays({6, 4, 4, 3}, /*seed=*/7);
  WriteKeras(path, arrays);
  const std::vector<double> wanted = ReadNbrdf(path).weights();
  using Names = std::vector<std::string>;
  const auto read = [&](const std::string& parent, const Names& names, const std::string& kernel,
                        const std::string& bias, std::size_t length) {
    WriteLayers(path, arrays, parent, names, kernel, bias, length);
    return ReadNbrdf(path).weights();
  };
  const Names numbers = {"dense_9", "dense_10", "dense_11"},
              first = {"dense", "dense_1", "dense_2"};
  EXPECT_EQ(read("/", numbers, "/a/kernel:0", "/a/bias:0", 0), wanted);
  EXPECT_EQ(read("/model_weights/", first, "/dense/kernel:0", "/dense/bias:0", 0), wanted);
  EXPECT_EQ(read("/model_weights/", first, "/m/dense/kernel", "/m/dense/bias", 8), wanted);
  EXPECT_EQ(read("/layers/", first, "/vars/0", "/vars/1", 0), wanted);
  const Names words = {"one", "two", "three"}, backwards = {"dense_3", "dense_2", "dense_1"};
  for (const Names& names : {words, backwards}) {
    EXPECT_EQ(read("/", names, "/one/kernel:0", "/one/bias:0", 7), wanted);
    EXPECT_EQ(read("/", names, "/one/kernel:0", "/one/bias:0", H5T_VARIABLE), wanted);
  }
  EXPECT_THAT(ErrorOf([&] { read("/", words, "/one/kernel:0", "/one/bias:0", 0); }),
              HasSubstr("x.h5: layers one and three, and no list layer_names says"));
  EXPECT_THAT(ErrorOf([&] { read("/", first, "/a/kernel:0", "/a/gamma:0", 0); }),
              HasSubstr("x.h5: dataset /dense/a/bias:0 is missing"));
  EXPECT_THAT(ErrorOf([&] { read("/", first, "/a/beta:0", "/a/gamma:0", 0); }),
              HasSubstr("x.h5: dataset /dense/a/beta:0 isn't a dense layer's kernel or bias"));
  // By content, under another name.
  read("/", words, "/one/kernel:0", "/one/bias:0", H5T_VARIABLE);
  std::filesystem::rename(path, folder / "weights");
  EXPECT_EQ(OpenNetwork(folder / "weights").weights(), wanted);
}

TEST(NbrdfFiles, ModelsOfKeras3AreArchives) {
  TemporaryFolder folder;
  const std::string weights = folder / "x.h5", path = folder / "x.keras";
  WriteLayers(weights, RandomArrays({6, 4, 4, 3}, /*seed=*/7), "/layers/",
              {"dense", "dense_1", "dense_2"}, "/vars/0", "/vars/1", 0);
  const std::string bytes = ReadFile(weights, kMaxWeightFileSize);
  WriteArchive(path, "model.weights.h5", bytes);
  EXPECT_EQ(ReadNbrdf(path).weights(), ReadNbrdf(weights).weights());
  // By content, under another name.
  std::filesystem::copy(path, folder / "model");
  EXPECT_EQ(OpenNetwork(folder / "model").weights(), ReadNbrdf(weights).weights());

  const auto error = [&] { return ErrorOf([&] { OpenBrdf(path); }); };
  const std::string archive = ReadFile(path, kMaxWeightFileSize);
  WriteBytes(path, archive.substr(0, archive.size() - 30));
  EXPECT_THAT(error(), HasSubstr("x.keras: truncated or damaged ZIP archive"));
  for (std::size_t at : {archive.size() / 4, archive.size() / 2, 3 * archive.size() / 4}) {
    std::string damaged = archive;
    damaged[at] ^= 0x55;
    WriteBytes(path, damaged);
    EXPECT_THAT(error(), HasSubstr("x.keras: truncated or damaged ZIP archive"));
  }
  WriteArchive(path, "other.h5", bytes);
  EXPECT_THAT(error(), HasSubstr("x.keras: a ZIP archive without model.weights.h5"));
  WriteArchive(path, "model.weights.h5", "nonsense");
  EXPECT_THAT(error(), HasSubstr("x.keras: not an HDF5 file"));
}

TEST(NbrdfFiles, FilesOfEveryKerasHoldTheSameNetwork) {
  PBNBRDF_REFERENCE_FILE(folder, "faults/keras");
  const DirectionPair pair = {FromSpherical(0.6, 0.0), FromSpherical(0.5, 2.5)};
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".h5") continue;
    Rgb value;
    OpenBrdf(entry.path())->Evaluate({&pair, 1}, {&value, 1});
    EXPECT_NEAR(value[0], 0.07152, 5e-6) << entry.path();
    EXPECT_EQ(value[1] + value[2], 0.0);
    ++files;
  }
  EXPECT_EQ(files, 7);
}

TEST(NbrdfFiles, UnusableHdf5FilesAreNamedAndNothingIsPrinted) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  const auto error = [&] { return ErrorOf([&] { OpenBrdf(path); }); };
  testing::internal::CaptureStderr();
  EXPECT_THAT(error(), HasSubstr("x.h5: no such file"));
  WriteBytes(path, "{\"layers\": []}");
  EXPECT_THAT(error(), HasSubstr("x.h5: not an HDF5 file"));
  WriteKeras(path, RandomArrays({6, 4, 3}, 1), H5T_STD_I32LE);
  EXPECT_THAT(error(), HasSubstr("kernel:0 is not of type float32 or float64"));
  std::filesystem::resize_file(path, 1000);
  EXPECT_THAT(error(), HasSubstr("x.h5: truncated or damaged HDF5 file (truncated file: eof = "));
  std::filesystem::resize_file(path, (64 << 20) + 1);
  EXPECT_THAT(error(), HasSubstr("67108865 bytes, at most 67108864 were expected"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(NbrdfFiles, DataElsewhereOrInChunksIsRefused) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5", other = folder / "other";
  WriteBytes(other, std::string(96, '\0'));
  const auto write = [&](hid_t creation) {
    H5Writer file(path);
    file.Add(DatasetName("fc1"), {{6, 4}, std::vector<double>(24)}, H5T_IEEE_F32LE, creation);
  };
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(creation, other.c_str(), 0, 96);
  write(creation);
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(path); }), HasSubstr("kernel:0 is not stored contiguously"));
  H5Pclose(creation);

  const hid_t chunked = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk[2] = {6, 4};
  H5Pset_chunk(chunked, 2, chunk);
  write(chunked);
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(path); }), HasSubstr("h5repack -f NONE -l CONTI IN OUT"));
  H5Pclose(chunked);

  WriteKeras(other, RandomArrays({6, 4, 3}, 1));
  {
    H5Writer file(path);
    H5Lcreate_external(other.c_str(), "/dense_1", file.file(), "/dense_1", file.links(),
                       H5P_DEFAULT);
  }
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(path); }), HasSubstr("x.h5: expected dense layers of Keras"));
}

// HDF5 1.10 would allocate memory until there is none.
TEST(NbrdfFiles, AHeapThatRunsInACircleIsRefused) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  WriteKeras(path, RandomArrays({6, 3, 3}, /*seed=*/5));
  std::string bytes = FileBytes(path);
  const std::size_t heap = bytes.find("HEAP");
  ASSERT_NE(heap, std::string::npos);
  std::uint64_t first_free, segment;
  std::memcpy(&first_free, bytes.data() + heap + 16, 8);
  std::memcpy(&segment, bytes.data() + heap + 24, 8);
  std::memcpy(bytes.data() + segment + first_free, &first_free, 8);
  WriteBytes(path, bytes);
  EXPECT_THAT(ErrorOf([&] { ReadNbrdf(path); }),
              HasSubstr(StrCat("x.h5: damaged HDF5 file (the heap at byte ", heap)));
}

// HDF5 reads whatever a file claims; damage ends in an Error, or in weights that are other numbers.
void ExpectErrorOrNetwork(const TemporaryFolder& folder, const std::string& good) {
  const std::string path = folder / "x.h5";
  testing::internal::CaptureStderr();
  const auto error = [&](const std::string& bytes) {
    std::filesystem::remove(path);  // some file systems wait for the disk when one is overwritten
    WriteBytes(path, bytes);
    return ErrorOf([&] { ReadNbrdf(path); });
  };
  for (std::size_t size = 0; size < good.size(); size += 1 + size / 100) {
    EXPECT_NE(error(good.substr(0, size)), "") << size;
  }
  std::mt19937 random(6);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = good;
    for (unsigned n = 1 + random() % 4; n > 0; --n) {
      bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    }
    const std::string message = error(bytes);
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    refused += !message.empty();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 100);
  EXPECT_EQ(error(good), "");
}

TEST(NbrdfFiles, DamagedHdf5FilesGiveAnErrorOrANetwork) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  WriteKeras(path, RandomArrays({6, 3, 3}, /*seed=*/5));
  ExpectErrorOrNetwork(folder, FileBytes(path));
}

TEST(NbrdfFiles, DamagedKerasFilesGiveAnErrorOrANetwork) {
  TemporaryFolder folder;
  const std::string path = folder / "x.h5";
  WriteKeras(path, RandomArrays({6, 3, 3}, /*seed=*/5));
  ExpectErrorOrNetwork(folder, NbrdfFiles(ReadNbrdf(path), path)[0].content);  // with attributes
}

// Unpacks an archive of published networks; false if there is no unzip.
bool Unpack(const std::string& archive, const std::string& folder) {
  return std::system("command -v unzip > /dev/null") == 0 &&
         std::system(StrCat("unzip -q '", archive, "' -d '", folder, "'").c_str()) == 0;
}

TEST(NbrdfFiles, AgreesWithTheOracle) {
  PBNBRDF_REFERENCE_FILE(oracle, "nbrdf/values.csv");
  PBNBRDF_REFERENCE_FILE(archive, "nbrdf/merl_nbrdf.zip");
  TemporaryFolder folder;
  if (!Unpack(archive, folder / "")) GTEST_SKIP() << "needs the program unzip";
  std::map<std::string, std::unique_ptr<Brdf>> materials;
  int rows = 0;
  double worst = 0.0;
  for (const std::vector<std::string>& row : ReadCsvRows(oracle)) {
    auto& material = materials[row[0]];
    if (!material) material = OpenBrdf(folder / ("merl_nbrdf/" + row[0] + ".h5"));
    const auto number = [&](int column) { return ParseNumber("oracle", row[column]); };
    const Rgb value = ValueAt(*material, {number(1), number(2), number(3)});
    for (int c = 0; c < 3; ++c) {
      const double expected = number(4 + c);
      const double error = std::abs(value[c] - expected) / (1e-3 + expected);
      EXPECT_LE(error, 1e-6) << row[0] << " " << row[1];
      worst = std::max(worst, error);
    }
    ++rows;
  }
  EXPECT_EQ(rows, 500);
  RecordProperty("worst_error", FormatNumber(worst));
}

TEST(NbrdfFiles, EveryPublishedNetworkIsRead) {
  PBNBRDF_REFERENCE_FILE(merl, "nbrdf/merl_nbrdf.zip");
  PBNBRDF_REFERENCE_FILE(nielsen, "nbrdf/nielsen_nbrdf.zip");
  TemporaryFolder folder;
  if (!Unpack(merl, folder / "") || !Unpack(nielsen, folder / "")) {
    GTEST_SKIP() << "needs the program unzip";
  }
  int networks = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "")) {
    if (entry.path().extension() != ".h5") continue;
    EXPECT_EQ(ReadNbrdf(entry.path()).shape().Description(), "6-21-21-3 relu") << entry;
    ++networks;
  }
  EXPECT_EQ(networks, 108);
  EXPECT_EQ(ReadNbrdf(folder / "merl_nbrdf/npy/blue-acrylic_fc1.npy").weights(),
            ReadNbrdf(folder / "merl_nbrdf/blue-acrylic.h5").weights());
}

}  // namespace
}  // namespace pbnbrdf
