#include "pbnbrdf/sources/sgd_file.h"

#include <map>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr char kHeader[] =
    "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n";
constexpr char kRow[] = ",0.1,0.2,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n";

TEST(Sgd, AgreesWithTheOracle) {
  PBNBRDF_REFERENCE_FILE(parameters, "sgd/parameters.csv");
  PBNBRDF_REFERENCE_FILE(oracle, "sgd/values.csv");
  std::map<std::string, std::unique_ptr<Brdf>> materials;
  int rows = 0;
  double worst = 0.0;
  for (const std::vector<std::string>& row : ReadCsvRows(oracle)) {
    auto& material = materials[row[0]];
    if (!material) material = OpenBrdf("sgd:" + parameters + "#" + row[0]);
    const auto number = [&](int column) { return ParseNumber("oracle", row[column]); };
    const DirectionPair pair = {FromSpherical(number(1), number(2)),
                                FromSpherical(number(3), number(4))};
    // The oracle itself rounds where tan^2 theta_h comes from 1 - cos^2 of a narrow lobe.
    const bool narrow = row[8] == "mirror" || row[8] == "near_mirror";
    Rgb value;
    material->Evaluate({&pair, 1}, {&value, 1});
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(value[c] - number(5 + c)) / number(5 + c);
      EXPECT_LE(error, narrow ? 1e-7 : 1e-12) << row[0] << " " << row[1];
      if (!narrow) worst = std::max(worst, error);
    }
    ++rows;
  }
  EXPECT_EQ(rows, 720);
  RecordProperty("worst_relative_error", std::to_string(worst));
}

TEST(Sgd, BadTablesAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "t.csv";
  const auto read = [&](const std::string& text, const std::string& material) {
    WriteBytes(path, text);
    return ErrorOf([&] { ReadSgd(path, material); });
  };
  const std::string row(kRow);
  const std::string good = std::string(kHeader) + "m,,r" + row + "m,alias,g" + row + "m,,b" + row;
  EXPECT_EQ(read(good, "m"), "");
  EXPECT_THAT(read(good, "x"), HasSubstr("t.csv: no material 'x'"));
  EXPECT_THAT(read("a,b\n", "m"), HasSubstr("t.csv: not a table of SGD parameters"));
  EXPECT_THAT(read(std::string(kHeader) + "m,,r" + row, "m"), HasSubstr("lacks a channel"));
  EXPECT_THAT(read(std::string(kHeader) + "m,,q" + row, "m"),
              HasSubstr("line 2: channel 'q' is not one of r | g | b"));
  EXPECT_THAT(read(std::string(kHeader) + "m,,r,1\n", "m"), HasSubstr("line 2: 4 columns"));
  EXPECT_THAT(read(std::string(kHeader) + "m,,r,nan" + row.substr(4), "m"),
              HasSubstr("line 2, rhoD: 'nan' is not a finite number"));
  EXPECT_THAT(ErrorOf([&] { OpenBrdf("sgd:" + path); }),
              HasSubstr("expected sgd:PARAMETERS.csv#MATERIAL"));
}

}  // namespace
}  // namespace pbnbrdf
