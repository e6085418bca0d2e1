// Files whose names say nothing, or something else, are told by what they hold.
#include <fstream>

#include "network/random_network.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

class OpenByContent : public testing::Test {
 protected:
  // What a file of that name and content is described as.
  std::string Opened(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return OpenBrdf(folder_ / name)->Description();
  }

  TemporaryFolder folder_;
};

TEST_F(OpenByContent, WhateverTheName) {
  const NetworkShape shape(Encoding::kMerl, {2}, Activation::kTanh);
  const NeuralBrdf network(shape, RandomWeights(shape, 0.5, /*seed=*/1));
  const std::string csv = "# isotropic\ntheta_i,phi_i,theta_o,phi_o,value\n0.1,0,0.2,3,0.5\n";
  const std::string alta = "#DIM 1 1\n#PARAM_IN COS_TH\n1 0.5\n";
  const std::string merl = MerlBrdf::Tabulate(*MakeBuiltin("spectralon")).FileBytes();
  for (const std::string name : {"a", "a.binary", "a.csv", "a.txt"}) {
    EXPECT_THAT(Opened(name, network.Serialized()), HasSubstr("neural BRDF 6-2-3")) << name;
    EXPECT_THAT(Opened(name, csv), HasSubstr("CSV measurements")) << name;
    EXPECT_THAT(Opened(name, alta), HasSubstr("ALTA measurements")) << name;
    EXPECT_THAT(Opened(name, R"({"model": "lambert", "parameters": {"rho_d": 0.5}})"),
                HasSubstr("ambert"))
        << name;
  }
  for (const std::string name : {"a", "a.binary", "a.txt"}) {
    EXPECT_THAT(Opened(name, merl), HasSubstr("MERL")) << name;
  }
}

TEST_F(OpenByContent, WhatIsNotRecognisedIsSaidToBeSo) {
  const auto error = [&](const std::string& name, const std::string& content) {
    return ErrorOf([&] { Opened(name, content); });
  };
  for (const std::string& content : std::vector<std::string>{
           "", "some prose, theta\n", std::string(100, '\xff'), "\x89PNG\r\n", "1 2 3\n4 5 6\n"}) {
    EXPECT_THAT(
        error("a.txt", content),
        HasSubstr("a.txt: not recognised; it is none of: collection of materials, safetensors"));
  }
  EXPECT_THAT(error("a", "x"), HasSubstr("Cornell measurements, in-plane measurements, CSV"));
  // Not by a name without its dot, and by one in capitals.
  EXPECT_THAT(error("binary", "x"), HasSubstr("not recognised"));
  EXPECT_THAT(error("A.BINARY", std::string(100, '\0')), HasSubstr("not a MERL file: its header"));
}

TEST_F(OpenByContent, ADamagedFileIsReportedAsWhatItsNameSays) {
  EXPECT_THAT(ErrorOf([&] { Opened("a.csv", "nonsense\n"); }), HasSubstr("must name the columns"));
  EXPECT_THAT(ErrorOf([&] { Opened("a.json", "nonsense\n"); }), HasSubstr("not a JSON file"));
  EXPECT_THAT(ErrorOf([&] { Opened("a.h5", "nonsense\n"); }), HasSubstr("HDF5"));
}

}  // namespace
}  // namespace pbnbrdf
