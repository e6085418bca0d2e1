#include "sources/source_list.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SourceList : public testing::Test {
 protected:
  SourceList() {
    for (const char* name : {"b.binary", "a.binary", "a[1].csv"}) WriteBytes(folder_ / name, name);
    const std::string row = ",0.1,0.2,0.1,1,0.04,0,0,1,0.5,40,0,0\n";
    std::string table =
        "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n";
    for (const char* name : {"red", "rose", "blue"}) {
      for (const char* channel : {"r", "g", "b"}) table += StrCat(name, ",x,", channel, row);
    }
    WriteBytes(folder_ / "sgd.csv", table);
  }

  TemporaryFolder folder_;
};

TEST_F(SourceList, PatternsStandForSeveral) {
  const std::string a = folder_ / "a.binary", b = folder_ / "b.binary", sgd = folder_ / "sgd.csv";
  EXPECT_THAT(ExpandSources(folder_ / "*.binary"), ElementsAre(a, b));
  EXPECT_THAT(ExpandSources(b + "; " + (folder_ / "*.binary")), ElementsAre(b, a));
  EXPECT_THAT(ExpandSources("sgd:" + sgd + "#r*"),
              ElementsAre("sgd:" + sgd + "#red", "sgd:" + sgd + "#rose"));
  EXPECT_THAT(ExpandSources("builtin:satin-*"), testing::Contains("builtin:satin-gold"));
  // A name that is a pattern, too.
  EXPECT_THAT(ExpandSources(folder_ / "a[1].csv"), ElementsAre(folder_ / "a[1].csv"));
  EXPECT_THAT(ErrorOf([&] { ExpandSources(folder_ / "*.bsdf"); }),
              HasSubstr("*.bsdf: nothing has a name like this"));
}

TEST_F(SourceList, NamesOfFiles) {
  EXPECT_EQ(NameOfSource("merl/gold.metallic.binary"), "gold.metallic");
  EXPECT_EQ(NameOfSource("sgd:parameters.csv#nylon"), "nylon");
  EXPECT_EQ(NameOfSource("builtin:spectralon"), "spectralon");
}

TEST_F(SourceList, FingerprintsChangeWithTheContent) {
  const std::string a = folder_ / "a.binary", sgd = "sgd:" + (folder_ / "sgd.csv");
  const std::uint64_t before = SourceFingerprint(a);
  EXPECT_EQ(SourceFingerprint(a), before);
  EXPECT_NE(SourceFingerprint(sgd + "#red"), SourceFingerprint(sgd + "#blue"));
  WriteBytes(a, "A.binary");
  EXPECT_NE(SourceFingerprint(a), before);
  EXPECT_NE(SourceFingerprint("builtin:spectralon"), SourceFingerprint("builtin:satin-gold"));
  EXPECT_THAT(ErrorOf([&] { SourceFingerprint(folder_ / "none"); }), HasSubstr("no such file"));
  std::vector<std::string> files;
  for (const char* name : {"fc1", "b1", "fc2", "b2", "fc3", "b3"})
    WriteBytes(folder_ / (std::string("x_") + name + ".npy"), name);
  const std::uint64_t network = SourceFingerprint(folder_ / "x_fc1.npy");
  WriteBytes(folder_ / "x_b3.npy", "B3");
  EXPECT_NE(SourceFingerprint(folder_ / "x_fc1.npy"), network);
}

TEST(NamesOfSources, TellSourcesOfTheSameNameApart) {
  EXPECT_THAT(
      NamesOfSources({"merl/gold.binary", "sgd:p.csv#gold", "builtin:gold", "sgd:p.csv#nylon"}),
      testing::ElementsAre("merl-gold", "sgd-gold", "builtin-gold", "nylon"));
  EXPECT_THAT(ErrorOf([] {
                NamesOfSources({"a/x/gold.binary", "b/x/gold.csv"});
              }),
              testing::HasSubstr("would both be named x-gold"));
}

}  // namespace
}  // namespace pbnbrdf
