// Files cut off at every 1/20 of their length, as each of the formats that OpenBrdf reads.
// (The tests of RGL and of scattered measurements have their own.)
#include "pbnbrdf/sources/open_brdf.h"

#include "network/random_network.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"

namespace pbnbrdf {
namespace {

class TruncatedFiles : public testing::Test {
 protected:
  // Cuts the file, which is read as the source now; it, and no other, has to be named as bad.
  void ExpectRefused(const std::string& path, const std::string& source) {
    const std::string whole = ReadFile(path, 1 << 26);
    EXPECT_EQ(ErrorOf([&] { OpenBrdf(source); }), "");
    for (std::size_t k = 0; k < 20; ++k) {
      WriteBytes(path, whole.substr(0, whole.size() * k / 20));
      const std::string error = ErrorOf([&] { OpenBrdf(source); });
      EXPECT_THAT(error, testing::StartsWith(path + ": ")) << k;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    WriteBytes(path, whole);
  }
  void ExpectRefused(const std::string& path) { ExpectRefused(path, path); }

  TemporaryFolder folder_;
};

NeuralBrdf Network(Encoding encoding, Activation activation) {
  const NetworkShape shape(encoding, {21, 21}, activation);
  return NeuralBrdf(shape, RandomWeights(shape, 0.5, 1));
}

TEST_F(TruncatedFiles, OfFittedNetworks) {
  Network(Encoding::kMerl, Activation::kTanh).Write(folder_ / "a.safetensors");
  ExpectRefused(folder_ / "a.safetensors");
}

TEST_F(TruncatedFiles, OfPublishedNetworks) {
  const NeuralBrdf network = Network(Encoding::kCartesian, Activation::kRelu);
  for (const char* name : {"a.h5", "fc1.npy"}) WriteFiles(NbrdfFiles(network, folder_ / name));
  ExpectRefused(folder_ / "a.h5");
  for (const char* name : {"fc1.npy", "fc2.npy", "fc3.npy", "b1.npy", "b2.npy", "b3.npy"}) {
    ExpectRefused(folder_ / name, folder_ / "fc1.npy");
  }
}

TEST_F(TruncatedFiles, OfMerlTables) {
  MerlBrdf::Tabulate(*MakeBuiltin("satin-gold")).Write(folder_ / "a.binary");
  ExpectRefused(folder_ / "a.binary");
}

TEST_F(TruncatedFiles, OfAnalyticModels) {
  WriteBytes(folder_ / "a.json", AnalyticBrdf::FromText("ggx:alpha=0.1").Json());
  ExpectRefused(folder_ / "a.json");
}

TEST_F(TruncatedFiles, OfShiftedGammaParameters) {
  const std::string path = folder_ / "a.csv";
  std::string text =
      "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n";
  for (const char* channel : {"r", "g", "b"}) {
    text += StrCat("steel,,", channel, ",0.01,0.5,0.002,0.6,0.9,0.1,50,2,4,1.5,0.25,0.0125\n");
  }
  WriteBytes(path, text);
  ExpectRefused(path, "sgd:" + path + "#steel");
}

}  // namespace
}  // namespace pbnbrdf
