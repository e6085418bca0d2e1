#include <hdf5.h>

#include <algorithm>

#include "pbnbrdf/base/error.h"
#include "sources/hdf5_handles.h"
#include "sources/keras_h5.h"

namespace pbnbrdf {
namespace {

using Handle = Hdf5Handle;

// What the published files say; Keras takes files of any backend.
constexpr const char* kKerasVersion = "2.2.4";
constexpr const char* kBackend = "tensorflow";

void Check(bool done) {
  if (!done) Fail("HDF5 failed to write a Keras file: ", Hdf5Reason());
}

Handle Checked(Handle handle) {
  Check(static_cast<bool>(handle));
  return handle;
}

// Text of this many bytes, padded with zeros.
Handle TextType(std::size_t size) {
  Handle type = Checked({H5Tcopy(H5T_C_S1), H5Tclose});
  Check(H5Tset_size(type.get(), size) >= 0);
  Check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0);
  return type;
}

void WriteAttribute(const Handle& object, const char* name, const Handle& type, const Handle& space,
                    const void* data) {
  const Handle attribute =
      Checked({H5Acreate2(object.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
               H5Aclose});
  if (data != nullptr) Check(H5Awrite(attribute.get(), type.get(), data) >= 0);
}

// One text, of variable length as Keras stores them.
void AddText(const Handle& object, const char* name, const char* text) {
  const Handle type = Checked({H5Tcopy(H5T_C_S1), H5Tclose});
  Check(H5Tset_size(type.get(), H5T_VARIABLE) >= 0);
  WriteAttribute(object, name, type, Checked({H5Screate(H5S_SCALAR), H5Sclose}), &text);
}

// A list of texts, each padded to the longest, as NumPy stores them. Of an empty list NumPy makes
// float64 numbers, and so does Keras.
void AddTexts(const Handle& object, const char* name, const std::vector<std::string>& texts) {
  const hsize_t count = texts.size();
  const Handle space = Checked({H5Screate_simple(1, &count, nullptr), H5Sclose});
  if (texts.empty()) {
    const Handle number = Checked({H5Tcopy(H5T_IEEE_F64LE), H5Tclose});
    return WriteAttribute(object, name, number, space, nullptr);
  }
  std::size_t longest = 0;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::string bytes;
  for (std::string text : texts) {
    text.resize(longest);
    bytes += text;
  }
  WriteAttribute(object, name, TextType(longest), space, bytes.data());
}

Handle AddGroup(const Handle& parent, const std::string& name) {
  return Checked(
      {H5Gcreate2(parent.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose});
}

void AddDataset(const Handle& group, const char* name, const Tensor& tensor) {
  const std::vector<hsize_t> extents(tensor.shape.begin(), tensor.shape.end());
  const Handle space = Checked(
      {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose});
  const Handle creation = Checked({H5Pcreate(H5P_DATASET_CREATE), H5Pclose});
  Check(H5Pset_obj_track_times(creation.get(), false) >= 0);  // the same bytes each time
  const Handle dataset = Checked({H5Dcreate2(group.get(), name, H5T_IEEE_F32LE, space.get(),
                                             H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                                  H5Dclose});
  Check(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 tensor.values.data()) >= 0);
}

void AddLayer(const Handle& file, const KerasDenseLayer& layer) {
  const Handle outer = AddGroup(file, layer.name);
  AddTexts(outer, "weight_names", {layer.name + "/kernel:0", layer.name + "/bias:0"});
  const Handle inner = AddGroup(outer, layer.name);
  AddDataset(inner, "kernel:0", layer.kernel);
  AddDataset(inner, "bias:0", layer.bias);
}

std::string Image(const Handle& file) {
  Check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL) >= 0);
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  Check(size > 0);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  Check(H5Fget_file_image(file.get(), bytes.data(), bytes.size()) == size);
  return bytes;
}

}  // namespace

std::string KerasH5Bytes(const std::vector<KerasDenseLayer>& layers) {
  constexpr std::size_t kIncrement = 1 << 16;
  constexpr const char* kOutputLayer = "lambda_1";
  const Hdf5Turn turn;
  // In memory: WriteFile is what puts it on the disk whole.
  const Handle access = Checked({H5Pcreate(H5P_FILE_ACCESS), H5Pclose});
  Check(H5Pset_fapl_core(access.get(), kIncrement, /*backing_store=*/false) >= 0);
  const Handle file =
      Checked({H5Fcreate("keras.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose});
  std::vector<std::string> names;
  for (const KerasDenseLayer& layer : layers) names.push_back(layer.name);
  names.push_back(kOutputLayer);
  AddTexts(file, "layer_names", names);
  AddText(file, "backend", kBackend);
  AddText(file, "keras_version", kKerasVersion);
  for (const KerasDenseLayer& layer : layers) AddLayer(file, layer);
  AddTexts(AddGroup(file, kOutputLayer), "weight_names", {});
  return Image(file);
}

}  // namespace pbnbrdf
