#include "pbnbrdf/sources/scattered_files.h"

#include <fstream>
#include <iterator>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string FileText(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ScatteredFiles : public testing::Test {
 protected:
  std::vector<BrdfSample> Samples(const std::string& name, const std::string& text) const {
    return Open(name, text)->Measurements();
  }
  std::unique_ptr<Brdf> Open(const std::string& name, const std::string& text) const {
    WriteBytes(folder_ / name, text);
    return OpenBrdf(folder_ / name);
  }
  std::string ErrorOfOpening(const std::string& name, const std::string& text) const {
    return ErrorOf([&] { Open(name, text); });
  }

  TemporaryFolder folder_;
};

void ExpectNear(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

std::string Alta(const std::string& dim, const std::string& in, const std::string& out,
                 const std::string& rows) {
  return "#DIM " + dim + "\n#PARAM_IN " + in + "\n" +
         (out.empty() ? "" : "#PARAM_OUT " + out + "\n") + rows;
}

const std::string kTwoRows = "0.3 0.2 0.1 5\n0.3\t0.5 0.1 6\n";

TEST_F(ScatteredFiles, AltaCoordinatesAreWhatTheyAreCalled) {
  struct Case {
    const char *dim, *in, *rows;
    DirectionPair first;
    bool isotropic;
  };
  const Case cases[] = {
      {"3 1",
       "ISOTROPIC_TL_TV_PROJ_DPHI",
       "0.3 0 0.4 1\n0.3 0.1 0 1\n",
       {FromSpherical(0.3, 0), FromSpherical(0.4, kPi / 2)},
       true},
      {"3 1",
       "ISOTROPIC_TV_TL_DPHI",
       "0.4 0.3 1 1\n0.4 0.3 0 1\n",
       {FromSpherical(0.3, 0), FromSpherical(0.4, 1)},
       true},
      {"4 1",
       "SPHERICAL_TL_PL_TV_PV",
       "0.3 1 0.4 2 1\n0.3 2 0.4 3 1\n",
       {FromSpherical(0.3, 1), FromSpherical(0.4, 2)},
       false},
      {"4 1",
       "SPHERICAL_TL_PL_TV_PV",
       "0.3 1 0.4 2 1\n0.2 1 0.4 3 1\n",
       {FromSpherical(0.3, 1), FromSpherical(0.4, 2)},
       true},
      {"3 1", "RUSIN_TH_TD_PD", "0.3 0.2 1 1\n0.3 0.1 1 1\n",
       FromAngles({.theta_h = 0.3, .theta_d = 0.2, .phi_d = 1}), true},
      {"4 1", "RUSIN_TH_PH_TD_PD", "0.3 0.5 0.2 1 1\n0.3 2 0.2 1 1\n",
       FromAngles({.theta_h = 0.3, .theta_d = 0.2, .phi_d = 1, .phi_h = 0.5}), false},
      {"1 1", "COS_TH", "0.8 1\n0.7 1\n", {{0.6, 0, 0.8}, {0.6, 0, 0.8}}, true},
      {"6 1",
       "CARTESIAN",
       "0 3 4 0.6 0 0.8 1\n0 0 1 0 0 1 1\n",
       {{0.6, 0, 0.8}, {0, 0.6, 0.8}},
       true}};
  for (const Case& c : cases) {
    const auto brdf = Open("a.alta", Alta(c.dim, c.in, "", c.rows));
    const BrdfSample first = brdf->Measurements()[0];
    ExpectNear(first.pair.wi, c.first.wi);
    ExpectNear(first.pair.wo, c.first.wo);
    EXPECT_EQ(first.value, (Rgb{1, 1, 1})) << c.in;
    EXPECT_EQ(brdf->IsIsotropic(), c.isotropic) << c.in;
    EXPECT_THAT(brdf->Description(), HasSubstr(c.in));
  }
}

TEST_F(ScatteredFiles, AltaValuesMayBeWeightedByACosine) {
  const auto first = [&](const std::string& out) {
    return Samples("a.dat", Alta("3 1", "ISOTROPIC_TL_TV_PROJ_DPHI", out, kTwoRows))[0].value[2];
  };
  const double cos_v = std::cos(std::hypot(0.2, 0.1));
  EXPECT_EQ(first(""), 5.0);
  EXPECT_EQ(first("INV_STERADIAN"), 5.0);
  EXPECT_NEAR(first("INV_STERADIAN_COSINE_FACTOR"), 5.0 / cos_v, 1e-12);
  EXPECT_EQ(Samples("a.dat", Alta("1 3", "COS_TH", "RGB_COLOR", "0.5 1 2 3\n0.6 4 5 6\n"))[1].value,
            (Rgb{4, 5, 6}));
}

TEST_F(ScatteredFiles, AltaCommentsAndConfidenceAreSkipped) {
  const std::string text = "# DIM 9 9, in words\n#\n#SAMPLE \"x\"\n#VS 2\n" +
                           Alta("1 1", "COS_TH", "", "0.5 1 0.9 1.1\n\n#late\r\n0.6 2 1.9 2.1\r\n");
  EXPECT_EQ(Samples("a.alta", text)[1].value[0], 2.0);
  // By its content alone, too.
  EXPECT_THAT(Open("a.txt", text)->Description(), HasSubstr("ALTA measurements in COS_TH"));
}

TEST_F(ScatteredFiles, BadAltaFilesAreNamed) {
  const auto error = [&](const std::string& text) { return ErrorOfOpening("a.alta", text); };
  const std::string in = "ISOTROPIC_TL_TV_PROJ_DPHI";
  EXPECT_EQ(error(Alta("3 1", in, "", kTwoRows)), "");
  EXPECT_THAT(error(""), HasSubstr("a.alta: no measurements in it"));
  EXPECT_THAT(error("1 2 3\n"), HasSubstr("a.alta: not an ALTA file: no line #DIM"));
  EXPECT_THAT(error("#DIM 3 1\n1 2 3 4\n"), HasSubstr("not an ALTA file: no line #PARAM_IN"));
  EXPECT_THAT(error(Alta("3", in, "", kTwoRows)),
              HasSubstr("a.alta: line 1: #DIM is followed by 1 words, expected 2"));
  EXPECT_THAT(error(Alta("3 x", in, "", kTwoRows)), HasSubstr("#DIM: 'x' is not a whole number"));
  EXPECT_THAT(error(Alta("2 1", in, "", kTwoRows)),
              HasSubstr("#DIM says 2 coordinates, ISOTROPIC_TL_TV_PROJ_DPHI has 3"));
  EXPECT_THAT(error(Alta("3 2", in, "", kTwoRows)),
              HasSubstr("#DIM says 2 values; must be 1 or 3"));
  EXPECT_THAT(error(Alta("3 1", "STARK_2D", "", kTwoRows)),
              HasSubstr("#PARAM_IN STARK_2D is not one of ISOTROPIC_TL_TV_PROJ_DPHI | "));
  EXPECT_THAT(error(Alta("3 1", in, "ENERGY", kTwoRows)),
              HasSubstr("#PARAM_OUT=ENERGY is not one of INV_STERADIAN | "));
  EXPECT_THAT(error("#VS 3\n" + Alta("3 1", in, "", kTwoRows)), HasSubstr("#VS 3; must be 0 to 2"));
  EXPECT_THAT(error("#FORMAT binary\n" + Alta("3 1", in, "", kTwoRows)),
              HasSubstr("#FORMAT binary; only text is read"));
  EXPECT_THAT(error(Alta("3 1", in, "", "1 2 3\n")),
              HasSubstr("a.alta: line 3: 3 numbers, expected 4"));
  EXPECT_THAT(error(Alta("3 1", in, "", kTwoRows + "1 nan 3 4\n")),
              HasSubstr("a.alta: line 5, number 2: 'nan' is not a finite number"));
  EXPECT_THAT(error(Alta("3 1", in, "", "15 0 0 1\n")),
              HasSubstr("line 3: 15 isn't an angle in radians"));
  EXPECT_THAT(error(Alta("6 1", "CARTESIAN", "", "0 0 0 0 0 1 1\n")),
              HasSubstr("line 3: a direction has no length"));
  EXPECT_THAT(error(Alta("3 1", in, "", "0.1 0.2 0.3 4")),
              HasSubstr("line 3: the last line has no end"));
  EXPECT_THAT(error(Alta("3 1", in, "", "0.1 0.2 0.3 -4\n0.1 1.6 0 4\n")),
              HasSubstr("a.alta: no data: of 2 measurements none has both directions above"));
}

TEST_F(ScatteredFiles, CsvColumnsAreFoundByName) {
  const auto radians = Samples("a.csv",
                               "name,theta_o,phi_o,theta_i,phi_i,value\n"
                               "a,0.4,1,0.3,0,5\n\n# remark\nb,0.4,2,0.3,0,6\n");
  ExpectNear(radians[0].pair.wi, FromSpherical(0.3, 0));
  ExpectNear(radians[0].pair.wo, FromSpherical(0.4, 1));
  EXPECT_EQ(radians[1].value, (Rgb{6, 6, 6}));
  const auto degrees = Samples("a.csv",
                               "theta_i_deg,phi_i_deg,theta_o_deg,phi_o,r,g,b\n"
                               "30,180,60,1,1,2,3\n30,180,60,2,4,5,6\n");
  ExpectNear(degrees[0].pair.wi, FromSpherical(kPi / 6, kPi));
  ExpectNear(degrees[0].pair.wo, FromSpherical(kPi / 3, 1));
  EXPECT_EQ(degrees[1].value, (Rgb{4, 5, 6}));
  const auto vectors = Samples("a.csv",
                               "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n"
                               "0,0,2,3,0,4,1\n0,0,1,0,0,1,1\n");
  ExpectNear(vectors[0].pair.wo, {0.6, 0, 0.8});
}

TEST_F(ScatteredFiles, CsvChannelsAndIsotropyAreSeen) {
  const std::string header = "theta_i,phi_i,theta_o,phi_o,value\n";
  const std::string one = "0.3,1,0.4,2,5\n0,0,0.4,2,5\n0.4,1,0.4,2,5\n",
                    two = one + "0.3,2,0.4,2,5\n";
  EXPECT_EQ(Open("a.csv", header + one)->NumChannels(), 1);
  EXPECT_EQ(Open("a.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n0,0,0,0,1,1,1\n1,0,1,0,1,1,1\n")
                ->NumChannels(),
            3);
  EXPECT_TRUE(Open("a.csv", header + one)->IsIsotropic());
  EXPECT_FALSE(Open("a.csv", header + two)->IsIsotropic());
  EXPECT_TRUE(Open("a.csv", "# isotropic\n" + header + two)->IsIsotropic());
  EXPECT_FALSE(Open("a.csv", "#anisotropic\n" + header + one)->IsIsotropic());
}

TEST_F(ScatteredFiles, BadCsvFilesAreNamed) {
  const auto error = [&](const std::string& text) { return ErrorOfOpening("a.csv", text); };
  const std::string header = "theta_i,phi_i,theta_o,phi_o,value\n", row = "0.3,0,0.4,1,5\n";
  EXPECT_EQ(error(header + row + row), "");
  EXPECT_THAT(error(""), HasSubstr("a.csv: no line that names the columns theta_i,phi_i"));
  EXPECT_THAT(error("theta_i,phi_i,theta_o,value\n"),
              HasSubstr("a.csv: line 1: the first line must name the columns theta_i,phi_i"));
  EXPECT_THAT(error("theta_i,phi_i,theta_o,phi_o,r,g\n"), HasSubstr("must name the columns"));
  EXPECT_THAT(error(header + "1,2,3\n"), HasSubstr("a.csv: line 2: 3 columns, expected 5"));
  EXPECT_THAT(error(header + row + "0.3,0,0.4,1,inf\n"),
              HasSubstr("a.csv: line 3, value: 'inf' is not a finite number"));
  EXPECT_THAT(
      error(header + "30,0,0.4,1,5\n"),
      HasSubstr("a.csv: line 2, theta_i: 30 is 30 radians; must be 0 to 3.14159 (theta_i is "
                "in radians, theta_i_deg in degrees)"));
  EXPECT_THAT(error(header + "-0.3,0,0.4,1,5\n"), HasSubstr("theta_i: -0.3 is -0.3 radians"));
  EXPECT_THAT(error(header + "0.3,0,0.4,90,5\n"), HasSubstr("phi_o: 90 is 90 radians"));
  EXPECT_THAT(error("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n0,0,0,0,0,1,1\n"),
              HasSubstr("line 2: a direction has no length"));
  EXPECT_THAT(error(header), HasSubstr("a.csv: no data: of 0 measurements none"));
  EXPECT_THAT(error(header + row + "0.3,0,0.4,1,5"), HasSubstr("line 3: the last line has no end"));
}

// At every 1/20 of the length, unless the cut is just behind a line: then it is a shorter file.
TEST_F(ScatteredFiles, TruncationsAreRefused) {
  std::string alta = Alta("3 1", "ISOTROPIC_TL_TV_PROJ_DPHI", "", ""),
              csv = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (int n = 0; n < 50; ++n) {
    alta += StrCat(0.01 * n, " 0.25 0.125 3.5\n");
    csv += StrCat(0.01 * n, ",0,0.25,0.125,3.5\n");
  }
  for (const auto& [name, text] : {std::pair("a.alta", alta), std::pair("a.csv", csv)}) {
    int refused = 0;
    for (std::size_t k = 0; k < 20; ++k) {
      const std::string cut = text.substr(0, text.size() * k / 20);
      if (cut.ends_with('\n')) continue;
      EXPECT_THAT(ErrorOfOpening(name, cut), StartsWith(folder_ / name + ": ")) << k;
      ++refused;
    }
    EXPECT_GT(refused, 15);
  }
}

TEST_F(ScatteredFiles, TheRetroreflectorsAreRead) {
  PBNBRDF_REFERENCE_FILE(yellow, "alta/retro-3M-jaune.dat");
  PBNBRDF_REFERENCE_FILE(grey, "alta/retro-gray-tape.dat");
  const auto yellow_tape = OpenBrdf(yellow), grey_tape = OpenBrdf(grey);
  EXPECT_THAT(yellow_tape->Description(), HasSubstr("isotropic, one channel, "));
  EXPECT_EQ(yellow_tape->NumChannels(), 1);
  // Row 5 of the former, which the data's description works out.
  const DirectionPair pair = {FromSpherical(15 * kPi / 180, 0),
                              Vec3{-0.983458, -0.173410, 0.052336}};
  Rgb value;
  yellow_tape->Evaluate({&pair, 1}, {&value, 1});
  EXPECT_NEAR(value[0], 0.0524221, 1e-4);
  // The latter is largest just where light goes back.
  const auto samples = grey_tape->Measurements();
  const auto most = std::max_element(samples.begin(), samples.end(),
                                     [](auto& a, auto& b) { return a.value[0] < b.value[0]; });
  EXPECT_NEAR(most->value[0], 72.457, 1e-3);
  ExpectNear(most->pair.wi, most->pair.wo);
  // The 86 rows at 90 degrees that each has are of no use.
  EXPECT_EQ(samples.size() + yellow_tape->Measurements().size(), 7397u + 7405u - 2 * 86u);
}

TEST_F(ScatteredFiles, AOneDimensionalFileIsRead) {
  PBNBRDF_REFERENCE_FILE(path, "alta/pink-felt-1d.alta");
  const auto brdf = OpenBrdf(path);
  EXPECT_EQ(brdf->Measurements().size(), 90u);
  EXPECT_EQ(brdf->NumChannels(), 3);
  EXPECT_EQ(brdf->Measurements()[0].value[1], 0.0794405192136765);
}

TEST_F(ScatteredFiles, TruncationsOfMeasuredFilesAreRefused) {
  for (const char* name : {"retro-3M-jaune.dat", "pink-felt-1d.alta"}) {
    PBNBRDF_REFERENCE_FILE(path, std::string("alta/") + name);
    const std::string text = FileText(path);
    for (std::size_t k = 0; k < 20; ++k) {
      const std::string cut = text.substr(0, text.size() * k / 20);
      EXPECT_THAT(ErrorOfOpening(name, cut), StartsWith(folder_ / name + ": ")) << name << " " << k;
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
