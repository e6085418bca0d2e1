// make_seeds.cc: small valid files of every format, for the fuzz targets to start from.
//
//   make_seeds FOLDER PROBLEMS      PROBLEMS: the folder problems/ of the sources
//
// A seed is FOLDER/TARGET/FORMAT/NAME: TARGET_fuzz runs on each FORMAT by itself.
#include <cstdio>
#include <filesystem>

#include "network/random_network.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/network/weight_family.h"
#include "sources/archive_writer.h"
#include "sources/npy_writer.h"
#include "sources/rgl_writer.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxBytes = 1 << 20;

class Seeds {
 public:
  explicit Seeds(std::string folder) : folder_(std::move(folder)) {}

  void Add(const std::string& target_and_format, const std::string& bytes) {
    const std::string folder = folder_ + "/" + target_and_format;
    std::filesystem::create_directories(folder);
    WriteFile(StrCat(folder, "/", ++count_), bytes);
  }

 private:
  std::string folder_;
  int count_ = 0;
};

// A model of Keras 3: the weights in a ZIP archive.
std::string KerasArchive(const std::string& weights) {
  const std::string path = std::filesystem::temp_directory_path() / "make_seeds.keras";
  WriteArchive(path, "model.weights.h5", weights);
  const std::string bytes = ReadFile(path, kMaxBytes);
  std::filesystem::remove(path);
  return bytes;
}

// A shared network of two materials.
std::string PriorBytes() {
  const NetworkShape shape(Encoding::kReciprocal, {2}, Activation::kTanh);
  const std::string path = std::filesystem::temp_directory_path() / "make_seeds.prior";
  WeightFamily(shape, RandomWeights(shape, 0.5, /*seed=*/1), RandomWeights(shape, 0.5, /*seed=*/2),
               {{"a", {1.0}}, {"b", {-1.0}}})
      .Write(path);
  const std::string bytes = ReadFile(path, kMaxBytes);
  std::filesystem::remove(path);
  return bytes;
}

void AddNetworks(Seeds* seeds) {
  for (const Encoding encoding : {Encoding::kMerl, Encoding::kReciprocal}) {
    const NetworkShape shape(encoding, {2}, Activation::kTanh);
    seeds->Add("source/safetensors",
               NeuralBrdf(shape, RandomWeights(shape, 0.5, /*seed=*/1)).Serialized());
  }
  seeds->Add("source/prior", PriorBytes());
  const NetworkShape shape(Encoding::kCartesian, {21, 21}, Activation::kRelu);
  const NeuralBrdf published(shape, RandomWeights(shape, 0.1, /*seed=*/2));
  const std::string h5 = ExportedFiles(published, "h5", "seed.h5").front().content;
  seeds->Add("source/keras", h5);
  seeds->Add("source/keras_archive", KerasArchive(h5));
  for (const char* type : {"<f4", "<f8"}) {
    const std::string data =
        type[2] == '4' ? ElementBytes<float>({1, 2, 3, 4}) : ElementBytes<double>({1, 2, 3, 4});
    seeds->Add("npy/npy", NpyBytes(NpyHeader(type, "2, 2"), data));
    seeds->Add("npy/npy", NpyBytes(NpyHeader(type, "4,", "True"), data, 2));
  }
}

void AddTables(Seeds* seeds) {
  std::string merl;
  for (const std::int32_t size : {2, 3, 4}) merl.append(reinterpret_cast<const char*>(&size), 4);
  seeds->Add("source/merl", merl + ElementBytes<double>(std::vector<double>(3 * 2 * 3 * 4, 100.0)));
  for (const std::uint64_t n_phi : {1, 3}) {
    seeds->Add("source/rgl", ConstantFile(n_phi, {0.1f, 0.2f, 0.3f}).Bytes());
    seeds->Add("source/rgl", ConstantFile(n_phi, std::vector<float>(16, 0.5f)).Bytes());
  }
}

void AddTexts(Seeds* seeds) {
  seeds->Add("source/csv",
             "# isotropic\ntheta_i,phi_i,theta_o,phi_o,r,g,b,sigma\n0.1,0,0.2,3,0.5,0.1,1e-3,0.1\n"
             "0.3,0,1.2,2,0.5,0.1,nan,0.1\n");
  seeds->Add("source/csv",
             "theta_i_deg; phi_i_deg; theta_o_deg; phi_o_deg; value\n10;0;-20;3;0.5\n");
  seeds->Add("source/csv", "wi_x\twi_y\twi_z\two_x\two_y\two_z\tvalue\n0\t0\t1\t0.1\t0\t1\t2\n");
  seeds->Add("source/alta", "#DIM 1 1\n#PARAM_IN COS_TH\n1 0.5\n0.5 0.25\n");
  seeds->Add(
      "source/alta",
      "#DIM 4 3\n#PARAM_IN SPHERICAL_TL_PL_TV_PV\n#PARAM_OUT RGB_COLOR\n0.1 0 0.2 3 1 2 3\n");
  seeds->Add("source/cornell",
             "# a paint\r\n\r\n4 # of them\r\n400 500\r\n600 700\r\n"
             "0.5 0 0.4 3 0.2 0.2\n0.2 0.2\n0.6 0 0.1 2 0.1 0.4 0 0.3");
  seeds->Add("source/fred",
             "type bsdf_data\r\nformat angles=deg bsdf=value "
             "scale=1\r\n10\t0\r\n0\t0\t0.5\r\n20\t30\t0.25\r\n");
  seeds->Add("source/astm",
             "TITLE a paint\r\nNUM_POINTS 2\r\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\r\n"
             "0.5,0,0.4,3,1,2,3\r\n0.5,0,0.4,2,1,2,3\r\n");
  seeds->Add("source/astm",
             "TITLE a paint\nNUM_POINTS 1\nVARS theta_i,phi_i,theta_s,phi_s,400nm,550nm,700nm\n"
             "0.5,0,0.4,3,1,2,3\n");
  seeds->Add("source/in_plane",
             "phi_i theta_i phi_o theta_o brdf\n20 180 30 0 0.5\n20 180 -40 0 0.25\n");
  for (const char* content : {"Monochrome", "XYZ"}) {
    std::string zemax =
        StrCat("# a test\nSource\tMeasured\nSymmetry PlaneSymmetrical\nSpectralContent  ", content,
               "\nScatterType  BRDF\nSampleRotation 1\n0\nAngleOfIncidence "
               "2\n20\t50\nScatterAzimuth 2\n0\t180\n"
               "ScatterRadial 2\n0\t10\n\n");
    for (const char* channel : {"TristimulusX", "TristimulusY", "TristimulusZ"}) {
      zemax += StrCat(*content == 'X' ? channel : "Monochrome",
                      "\nDataBegin\nTIS 0.5\n1\t2\n1\t2\nTIS 0.5\n1\t2\n1\t2\nDataEnd\n");
      if (*content == 'M') break;
    }
    seeds->Add("source/zemax", zemax);
  }
  seeds->Add("source/model", R"({"model": "lambert", "parameters": {"rho_d": [0.5, 0.4, 0.3]}})");
  seeds->Add("source/model", R"({"model": "ggx", "parameters": {"roughness": 0.3}})");
}

void AddScenes(Seeds* seeds, const std::string& problems) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(problems)) {
    const std::string ending = entry.path().extension();
    const std::string bytes = entry.is_regular_file() ? ReadFile(entry.path(), kMaxBytes) : "";
    // To paint a sky takes a second under the sanitizers.
    if (ending == ".json" && bytes.find("\"sky\"") == bytes.npos) seeds->Add("scene/json", bytes);
    if (ending == ".flags") seeds->Add("problem/flags", bytes);
  }
  seeds->Add("scene/json", R"({
    "camera": {"origin": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0], "field_of_view": 30},
    "film": {"width": 8, "height": 8}, "materials": {"a": {"source": "builtin:satin-gold"}},
    "shapes": [{"type": "sphere", "radius": 0.5, "material": "a"}],
    "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": [1, 2, 3]},
               {"type": "environment", "radiance": [1, 2, 3], "rotation": 20, "scale": 2}]})");
  seeds->Add(
      "mesh/obj",
      "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 \\\n3//1 4//1\n");
}

void AddMeshesAndImages(Seeds* seeds) {
  seeds->Add("mesh/obj", "f -1 1 2\nv 0 0 0\nv 1 0 0\nv 1 1 0 # behind\n");
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  seeds->Add("mesh/ply",
             "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\n"
             "property float y\nproperty float z\n" +
                 faces + "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n");
  seeds->Add(
      "mesh/ply",
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\n" +
          faces + ElementBytes<float>({0, 0, 0, 1, 0, 0, 1, 1, 0}) + '\3' +
          ElementBytes<std::int32_t>({0, 1, 2}));
  Image image(5, 3);
  for (std::size_t n = 0; n < image.rgb.size(); ++n) image.rgb[n] = 0.05f * float(n);
  seeds->Add("image/exr", ExrBytes(image));
  seeds->Add("image/png", PngBytes(image));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: make_seeds FOLDER PROBLEMS\n");
    return 2;
  }
  pbnbrdf::Seeds seeds(argv[1]);
  pbnbrdf::AddNetworks(&seeds);
  pbnbrdf::AddTables(&seeds);
  pbnbrdf::AddTexts(&seeds);
  pbnbrdf::AddScenes(&seeds, argv[2]);
  pbnbrdf::AddMeshesAndImages(&seeds);
  for (int n = 0; n < 8; ++n) {  // of no format: whatever the fit makes of it
    seeds.Add("fit/random",
              std::string(reinterpret_cast<const char*>(
                              pbnbrdf::RandomNumbers(40, 0.0, 1.0, unsigned(n)).data()),
                          320));
  }
}
