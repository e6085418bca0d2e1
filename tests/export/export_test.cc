#include "pbnbrdf/export/export.h"
#include "pbnbrdf/sources/open_brdf.h"

#include "export/formats.h"
#include "export/networks.h"
#include "network/rounded_network.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"

namespace pbnbrdf {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

NeuralBrdf Relu(std::vector<int> hidden = {7, 5}) {
  return RandomNetwork(Encoding::kCartesian, Activation::kRelu, std::move(hidden), 4);
}

NeuralBrdf Merl() { return RandomNetwork(Encoding::kMerl, Activation::kTanh, {5}, 4); }

std::vector<double> AsFloats(std::vector<double> weights) {
  for (double& weight : weights) weight = static_cast<float>(weight);
  return weights;
}

TEST(Export, NbrdfFilesAreReadBack) {
  TemporaryFolder folder;
  const NeuralBrdf network = Relu();
  for (const auto& [format, name] :
       {std::pair{"h5", "a.h5"}, {"h5", "a.hdf5"}, {"npy", "a_fc1.npy"}, {"npy", "fc1.npy"}}) {
    Export(network, format, folder / name);
    const NeuralBrdf back = OpenNetwork(folder / name);
    EXPECT_EQ(back.shape().Description(), "6-7-5-3 relu");
    EXPECT_EQ(back.shape().encoding(), Encoding::kCartesian);
    EXPECT_EQ(back.weights(), AsFloats(network.weights())) << name;
  }
  EXPECT_EQ(folder.file_count(), 2u + 2 * 6);
  const NeuralBrdf deep = Relu({4, 4, 4, 4});
  Export(deep, "h5", folder / "deep.h5");
  EXPECT_EQ(OpenNetwork(folder / "deep.h5").weights(), AsFloats(deep.weights()));
}

TEST(Export, OneChannelBecomesThree) {
  TemporaryFolder folder;
  const NeuralBrdf one = RandomNetwork(Encoding::kCartesian, Activation::kRelu, {7, 5}, 4, 1);
  Export(one, "h5", folder / "a.h5");
  const NeuralBrdf back = OpenNetwork(folder / "a.h5");
  EXPECT_EQ(back.NumChannels(), 3);
  const std::vector<Rgb> expected = LibraryValues(one, HardPairs());
  const std::vector<Rgb> values = LibraryValues(back, HardPairs());
  for (std::size_t n = 0; n < values.size(); ++n) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(values[n][c], expected[n][0], 1e-5);
  }
}

TEST(Export, PublishedNetworksComeOutAsTheyWentIn) {
  PBNBRDF_REFERENCE_FILE(archive, "nbrdf/merl_nbrdf.zip");
  TemporaryFolder folder;
  if (std::system(StrCat("unzip -q '", archive, "' 'merl_nbrdf/npy/*' -d ", folder / "").c_str()) !=
      0) {
    GTEST_SKIP() << "needs the program unzip";
  }
  const std::string base = folder / "merl_nbrdf/npy/blue-acrylic_";
  const auto files = ExportedFiles(OpenNetwork(base + "fc1.npy"), "npy", base + "fc1.npy");
  ASSERT_EQ(files.size(), 6u);
  for (const FileContent& file : files) {
    EXPECT_EQ(file.content, ReadFile(file.path, 1 << 20)) << file.path;  // to the last byte
  }
}

TEST(Export, MerlIsWhatTabulateWrites) {
  TemporaryFolder folder;
  const NeuralBrdf network = Merl();
  Export(network, "merl", folder / "a.binary");
  MerlBrdf::Tabulate(network).Write(folder / "b.binary");
  EXPECT_EQ(ReadFile(folder / "a.binary", 1 << 26), ReadFile(folder / "b.binary", 1 << 26));
  EXPECT_EQ(MerlBrdf::Read(folder / "a.binary").valid_bins(), 1111326u);
}

TEST(Export, TheSameNetworkGivesTheSameBytes) {
  const NeuralBrdf network = RoundedOneByOne(Relu());
  for (const ExportFormat& exported : ExportFormats()) {
    if (exported.source == ExportSource::kPrincipled) continue;
    const std::string_view format = exported.name;
    const std::string path = format == "npy"       ? "fc1.npy"
                             : format == "h5"      ? "a.h5"
                             : format == "mitsuba" ? "a.py"
                                                   : "a";
    const auto once = ExportedFiles(network, format, path),
               twice = ExportedFiles(network, format, path);
    ASSERT_EQ(once.size(), twice.size());
    ASSERT_GE(once.size(), 1u);
    for (std::size_t n = 0; n < once.size(); ++n) {
      EXPECT_EQ(once[n].path, twice[n].path);
      EXPECT_TRUE(once[n].content == twice[n].content) << format;
    }
  }
}

TEST(Export, FunctionsAreNamedAsTheFileOrAsAsked) {
  const auto text = [](const std::string& path, const std::string& name) {
    return ExportedFiles(Merl(), "c", path, name)[0].content;
  };
  EXPECT_THAT(text("x/gold-paint.v2.h", ""), HasSubstr("static inline void gold_paint_eval("));
  EXPECT_THAT(text("x/gold.h", "paint"), HasSubstr("static inline void paint_eval("));
  EXPECT_THAT(ErrorOf([&] { text("3.h", ""); }), HasSubstr("name=3 is not a letter"));
}

TEST(Export, ArtistsGetPrincipledModelsOnly) {
  const AnalyticBrdf cloth = AnalyticBrdf::FromText("principled:sheen_color=0.5,roughness=0.75");
  EXPECT_THAT(ExportedFiles(cloth, "gltf", "x/a.gltf")[0].content,
              AllOf(HasSubstr("\"name\": \"a\""), HasSubstr("\"roughnessFactor\": 0.75"),
                    HasSubstr("KHR_materials_sheen"), Not(HasSubstr("extras"))));
  AnalyticBrdf remarked = cloth;
  remarked.set_metadata({{"material", "a --> <b>"}, {"errors", R"({"mean_abs_log_error": 0.25})"}});
  const std::string document = ExportedFiles(remarked, "materialx", "x/a.mtlx")[0].content;
  EXPECT_THAT(document, AllOf(HasSubstr("<!-- material: a - -&gt; &lt;b&gt; -->"),
                              HasSubstr("<!-- mean_abs_log_error: 0.25 -->"),
                              HasSubstr("name=\"sheen_roughness\" type=\"float\" value=\"0.5\"")));
  const auto error = [](const Brdf& source) {
    return ErrorOf([&] { ExportedFiles(source, "gltf", "x/a.gltf"); });
  };
  EXPECT_THAT(error(Merl()), HasSubstr("x/a.gltf: this format holds principled models only"));
  EXPECT_THAT(error(LambertBrdf({1, 1, 1})), HasSubstr("needs a principled model, not lambert"));
}

TEST(Export, MitsubaGetsItsWeightsBeside) {
  const auto files = ExportedFiles(Merl(), "mitsuba", "x/gold \"2\".py");
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].path, "x/gold \"2\"_weights.safetensors");
  EXPECT_EQ(files[0].content, Merl().Serialized());
  EXPECT_EQ(files[1].path, "x/gold \"2\"_proposal.safetensors");
  EXPECT_EQ(files[1].content, MitsubaProposal(FitProposal(Merl())));
  EXPECT_THAT(files[2].content, HasSubstr("b\"gold \\x222\\x22_weights.safetensors\""));
  EXPECT_THAT(files[2].content, HasSubstr("b\"gold \\x222\\x22_proposal.safetensors\""));
}

TEST(Export, WhatAFormatCannotHoldIsSaid) {
  const auto error = [](const NeuralBrdf& network, std::string_view format,
                        const std::string& path) {
    return ErrorOf([&] { ExportedFiles(network, format, path); });
  };
  for (std::string_view format : {"npy", "h5"}) {
    const std::string path = format == "npy" ? "fc1.npy" : "a.h5";
    EXPECT_EQ(error(Merl(), format, path),
              "an NBRDF network has relu units and the cartesian encoding, this one is tanh, merl; "
              "fit with --encoding=cartesian --activation=relu");
    std::vector<double> weights = Relu().weights();
    weights[0] = -1e39;
    EXPECT_EQ(error(NeuralBrdf(Relu().shape(), weights), format, path),
              "weight -1e+39 is beyond float32");
  }
  EXPECT_EQ(error(Relu({4}), "npy", "fc1.npy"),
            "the NumPy files hold 3 layers, a 6-4-3 relu network has 2");
  EXPECT_THAT(error(Relu(), "npy", "a.npy"), StartsWith("a.npy: name the first layer's"));
  EXPECT_THAT(error(Relu(), "npy", "a.h5"), StartsWith("a.h5: NumPy files are named by"));
  EXPECT_THAT(error(Relu(), "h5", "fc1.npy"), HasSubstr("ends with .h5 or .hdf5"));
  EXPECT_THAT(error(Merl(), "mitsuba", "gold"), HasSubstr("gold: a Mitsuba plugin's name"));
  EXPECT_THAT(
      error(RandomNetwork(Encoding::kAnisotropic, Activation::kTanh, {4}, 1), "merl", "a.binary"),
      HasSubstr("a MERL table has no phi_h"));
}

}  // namespace
}  // namespace pbnbrdf
