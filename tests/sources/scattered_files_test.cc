#include "pbnbrdf/sources/scattered_files.h"

#include "brdf/direction_pairs.h"
#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

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
  EXPECT_EQ(error(Alta("3 1", in, "", kTwoRows + "0.1 0.2 0.3 4")), "");
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
                               "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,r,g,b\n"
                               "30,180,60,90,1,2,3\n30,180,60,45,4,5,6\n");
  ExpectNear(degrees[0].pair.wi, FromSpherical(kPi / 6, kPi));
  ExpectNear(degrees[0].pair.wo, FromSpherical(kPi / 3, kPi / 2));
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
      HasSubstr("a.csv: line 2: theta_i is 30 radians; must be -3.14159 to 3.14159 (theta_i is "
                "in radians, theta_i_deg in degrees"));
  EXPECT_THAT(error(header + "0.3,0,0.4,90,5\n"), HasSubstr("phi_o is 90 radians"));
  EXPECT_THAT(error("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n0,0,0,0,0,1,1\n"),
              HasSubstr("line 2: a direction has no length"));
  EXPECT_THAT(error(header), HasSubstr("a.csv: no data: of 0 measurements none"));
}

// Wherever the cut is, but in a line's last number or behind it: then it is a file, too.
TEST_F(ScatteredFiles, RowsThatAreCutOffAreRefused) {
  std::string alta = Alta("3 1", "ISOTROPIC_TL_TV_PROJ_DPHI", "", ""),
              csv = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (int n = 10; n < 50; ++n) {
    alta += StrCat(0.01 * n, " 0.25 0.125 3.5\n");
    csv += StrCat(0.01 * n, ",0,0.25,0.125,3.5\n");
  }
  for (const auto& [name, text] : {std::pair("a.alta", alta), std::pair("a.csv", csv)}) {
    for (std::size_t end = text.size() - 1; end > 100; end = text.rfind('\n', end - 1)) {
      const std::string cut = text.substr(0, end - 4);  // ".5" and what parts it from its neighbour
      EXPECT_THAT(ErrorOfOpening(name, cut), StartsWith(folder_ / name + ": ")) << end;
    }
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

std::string Row(double f) { return StrCat("0.3,0,0.4,2,", f, "\n"); }

TEST_F(ScatteredFiles, DialectsOfTextAreOneTable) {
  const std::string text = "theta_i,phi_i,theta_o,phi_o,value\n0.3,0,0.4,2,5\n0.2,0,0.1,1,-0.5\n";
  const auto with = [&](char separator, std::string part, const std::string& by) {
    std::string changed;
    for (char c : text) changed += c == separator ? by : std::string(1, c);
    return part + changed;
  };
  const auto wanted = Samples("a.csv", text);
  const std::string names = "\"theta_i\", 'Phi_I' ,THETA_o,\tphi_o ,\"Value\"\n";
  const std::string rows = text.substr(text.find('\n') + 1);
  for (const std::string& dialect :
       {with('\n', "", "\r\n"), with('\n', "", "\r"), with(',', "", ";"), with(',', "", "\t"),
        with(',', "", "  "), with(',', "", "\t \t"), with(',', "", ", "),
        with('x', "\xef\xbb\xbf", ""), text.substr(0, text.size() - 1), names + rows,
        "# theta_i,phi_i,theta_o,phi_o,value\n" + rows,
        "# a, b\n\n" + with('\n', "", "\n# theta_i, again\n"),
        text +
            "nan,0,0.3,1,5\n0.3,0,0.3,1,\n0.3,NA,0.3,1,1\n0,0,0,1,-\n0,0,0,1,NULL\n0,none,0,1,1\n",
        std::string("note,theta_i,phi_i,theta_o,phi_o,value\n\"of 5, 6\",0.3,0,0.4,2,5\n"
                    " \"\"\"a, b\"\" or c\" ,0.2,0,0.1,1,-0.5\n"),
        names + "3D-1,0d0,\"4.0D-01\",2,+.5D1\n0.2,0,1d-1,1.,-5.E-1"}) {
    for (const char* name : {"a.csv", "a.CSV", "a.txt", "a"}) {
      const auto found = Samples(name, dialect);
      ASSERT_EQ(found.size(), wanted.size()) << dialect;
      for (std::size_t n = 0; n < found.size(); ++n) {
        ExpectNear(found[n].pair.wo, wanted[n].pair.wo);
        EXPECT_EQ(found[n].value, wanted[n].value) << dialect;
      }
    }
  }
  EXPECT_THAT(Open("a.csv", text + "0.3,0,0.3,1,\n")->Description(),
              HasSubstr("2 measurements, 1 unusable ones left out"));
  // An empty cell between tabs, and at a line's end.
  EXPECT_THAT(
      Open("a.csv", with(',', "", "\t") + "0.3\t\t0.3\t1\t5\n0.3\t0\t0.3\t1\t\n")->Description(),
      HasSubstr("2 measurements, 2 unusable ones left out"));
}

TEST_F(ScatteredFiles, WhatMakesATextUnreadableIsNamed) {
  const std::string header = "theta_i;phi_i;theta_o;phi_o;value\n";
  EXPECT_THAT(ErrorOfOpening("a.csv", header + "0,3;0;0,4;2;0,5\n"),
              HasSubstr("a.csv: line 2, theta_i: '0,3' has a decimal comma; write a point"));
  EXPECT_THAT(ErrorOfOpening("a.csv", std::string("\xff\xfet\0h\0", 6)),
              HasSubstr("a.csv: UTF-16 text; save it as UTF-8"));
  EXPECT_THAT(ErrorOfOpening("a.txt", std::string("\xfe\xff\0t\0h", 6)), HasSubstr("UTF-16 text"));
  for (const bool big_endian : {false, true}) {  // without a byte order mark
    std::string utf16;
    for (char c : header) utf16 += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
    EXPECT_THAT(ErrorOfOpening("a.txt", utf16), HasSubstr("UTF-16 text"));
  }
  EXPECT_THAT(ErrorOfOpening("a.csv", "theta_i,phi_i,theta_o,phi_o,value\n0,1,0,0,4,0,5\n"),
              HasSubstr("line 2: 7 columns, expected 5; is there a decimal comma?"));
  EXPECT_THAT(ErrorOfOpening("a.csv", "theta_i,phi_i,theta_o,phi_o,value\n0,0,0,0,1e5d2\n"),
              HasSubstr("value: '1e5d2' is not a finite number"));
  EXPECT_THAT(ErrorOfOpening("a.csv", "theta_i,phi_i,theta_o,phi_o,value,Value\n0,0,0,0,1,1\n"),
              HasSubstr("a.csv: two columns have the name value"));
  EXPECT_THAT(ErrorOfOpening("a.csv", "theta_i,phi_i,theta_o,phi_o,value,sigma\n0,0,0,0,1,-1\n"),
              HasSubstr("line 2, sigma: -1; must be >= 0"));
}

TEST_F(ScatteredFiles, TwoReadingsOfOneQuantityAreRefused) {
  const auto error = [&](const std::string& names) {
    std::string row = "0.5";
    for (char c : names) row += c == ',' ? ",0.5" : "";
    return ErrorOfOpening("a.csv", names + "\n" + row + "\n");
  };
  EXPECT_EQ(error("theta_i,phi_i,theta_o,phi_o,value"), "");
  EXPECT_THAT(error("theta_i,theta_i_deg,phi_i,theta_o,phi_o,value"),
              HasSubstr("a.csv: columns theta_i in radians and theta_i_deg in degrees; write all"));
  EXPECT_THAT(error("theta_i_deg,phi_i,theta_o_deg,Phi_O,value"),
              HasSubstr("columns phi_i in radians and theta_i_deg in degrees"));
  EXPECT_THAT(error("theta_i,phi_i,theta_o,phi_o,r,value,g,b"),
              HasSubstr("a.csv: columns value and r, ...; leave out one"));
  EXPECT_THAT(error("theta_i,phi_i,theta_o,phi_o,value,sigma,sigma_r,sigma_g,sigma_b"),
              HasSubstr("columns sigma and sigma_r"));
  EXPECT_THAT(error("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,theta_i,value"),
              HasSubstr("directions as angles and as vectors"));
  EXPECT_THAT(error("theta_i,Theta_I,phi_i,theta_o,phi_o,value"),
              HasSubstr("two columns have the name theta_i"));
}

TEST_F(ScatteredFiles, ANegativeThetaIsOnTheOtherSide) {
  const auto samples =
      Samples("a.csv", "theta_i,phi_i,theta_o,phi_o,value\n-0.3,1,-0.5,2,5\n0.3,1,0.5,2,5\n");
  ExpectNear(samples[0].pair.wi, FromSpherical(0.3, 1 + kPi));
  ExpectNear(samples[0].pair.wo, FromSpherical(0.5, 2 + kPi));
}

TEST_F(ScatteredFiles, ASampleThatWasTurnedByHalfACircleIsOneMaterial) {
  const std::string header = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n";
  EXPECT_TRUE(
      Open("a.csv", header + "30,0,40,180,1\n30,180,50,0,1\n-30,0,20,0,1\n")->IsIsotropic());
  EXPECT_FALSE(Open("a.csv", header + "30,0,40,180,1\n30,179,50,0,1\n")->IsIsotropic());
}

// The weights written out: s = sigma cos_i / (1 + f cos_i), (median / s)^2, from 1e-4 to 1.
TEST_F(ScatteredFiles, DeviationsBecomeWeights) {
  const std::string columns = "theta_i,phi_i,theta_o,phi_o,value,sigma\n";
  const auto weights = [&](const std::string& text) {
    std::vector<double> found;
    for (const BrdfSample& s : Samples("a.csv", text)) found.push_back(s.weight);
    return found;
  };
  const double c = std::cos(0.5);
  const double s[] = {0.1 / (1 + 2), 0.2 * c / (1 + 4 * c), 0.4 * c, 100.0};
  const double median = 0.5 * (s[1] + s[2]);
  const auto found =
      weights(columns + "0,0,0,0,2,0.1\n0.5,0,0,0,4,0.2\n0.5,0,0,0,0,0.4\n0,0,0,0,0,100\n");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_LT(s[1], median);
  EXPECT_EQ(found[0], 1.0);
  EXPECT_EQ(found[1], 1.0);
  EXPECT_NEAR(found[2], median * median / (s[2] * s[2]), 1e-15);
  EXPECT_EQ(found[3], 1e-4);
  // Of three channels: as their mean.
  const std::string three = "theta_i,phi_i,theta_o,phi_o,r,g,b,sigma_r,sigma_g,sigma_b\n";
  const auto means = weights(three + "0,0,0,0,1,2,3,0.05,0.1,0.15\n0.5,0,0,0,3,4,5,0.1,0.2,0.3\n" +
                             "0.5,0,0,0,0,0,0,0.4,0.4,0.4\n0,0,0,0,0,0,0,100,100,100\n");
  EXPECT_THAT(means, testing::Pointwise(testing::DoubleNear(1e-15), found));
  // All known exactly, all alike, and not said.
  EXPECT_EQ(weights(columns + "0,0,0,0,2,0\n0.1,0,0,0,2,0\n"), (std::vector<double>{1, 1}));
  EXPECT_EQ(weights(columns.substr(0, columns.rfind(',')) + "\n" + Row(1) + Row(2)),
            (std::vector<double>{1, 1}));
}

// Properties over random rows: weights within their range, falling with sigma, and the same in any unit of sigma.
TEST_F(ScatteredFiles, WeightsFallWithSigma) {
  const std::vector<double> sigmas = RandomNumbers(200, 0.0, 1.0, 3);
  const auto weights = [&](double unit) {
    std::string text = "theta_i,phi_i,theta_o,phi_o,value,sigma\n";
    for (double sigma : sigmas) text += StrCat("0.3,0,0.4,2,5,", FormatNumber(unit * sigma), "\n");
    return Samples("a.csv", text);
  };
  const auto one = weights(1.0), eight = weights(8.0);
  for (std::size_t n = 0; n < sigmas.size(); ++n) {
    EXPECT_EQ(one[n].weight, eight[n].weight);
    EXPECT_GT(one[n].weight, 0.0);
    EXPECT_LE(one[n].weight, 1.0);
    for (std::size_t m = 0; m < n; ++m) {
      EXPECT_TRUE(sigmas[n] >= sigmas[m] || one[n].weight >= one[m].weight);
    }
  }
}

// Whatever their dialect they hold the same, or are refused for a reason.
TEST_F(ScatteredFiles, FilesOfOtherProgramsAreRead) {
  PBNBRDF_REFERENCE_FILE(folder, "faults/material_csv");
  const DirectionPair pair = {FromSpherical(0.6, 0.0), FromSpherical(0.5, 3.0)};
  for (const char* name :
       {"bom.csv", "empty_cell.csv", "nan.csv", "no_newline.csv", "plain.CSV", "plain.csv",
        "plain.txt", "quoted_header.csv", "semicolon.csv", "tab.csv"}) {
    const auto brdf = OpenBrdf(folder + "/" + name);
    Rgb value;
    brdf->Evaluate({&pair, 1}, {&value, 1});
    EXPECT_NEAR(value[0], 0.5223, 5e-5) << name;
    EXPECT_TRUE(brdf->IsIsotropic());
  }
  const auto error = [&](const std::string& name) {
    return ErrorOf([&] { OpenBrdf(folder + "/" + name); });
  };
  EXPECT_THAT(error("dup_columns.csv"), HasSubstr("two columns have the name value"));
  EXPECT_THAT(error("semicolon_decimal_comma.csv"), HasSubstr("has a decimal comma"));
  EXPECT_THAT(error("utf16.csv"), HasSubstr("UTF-16"));
  const auto in_plane = OpenBrdf(folder + "/deg_signed.csv"),
             plain = OpenBrdf(folder + "/plain.csv");
  EXPECT_TRUE(in_plane->IsIsotropic());
  for (const BrdfSample& sample : in_plane->Measurements()) {
    Rgb value;
    plain->Evaluate({&sample.pair, 1}, {&value, 1});
    EXPECT_NEAR(value[0], sample.value[0], 1e-9);
  }
}

TEST_F(ScatteredFiles, NoisyAndTurnedScansKeepAllTheirRows) {
  PBNBRDF_REFERENCE_FILE(folder, "faults/scattered");
  const std::pair<const char*, std::size_t> kRows[] = {
      {"inplane.csv", 644},          {"inplane_noise.csv", 644}, {"inplane_turned.csv", 644},
      {"random100_noise.csv", 100},  {"random3000.csv", 3000},   {"random3000_additive.csv", 3000},
      {"random3000_noise.csv", 3000}};
  for (const auto& [name, rows] : kRows) {
    const auto brdf = OpenBrdf(folder + "/" + name);
    EXPECT_EQ(brdf->Measurements().size(), rows) << name;
    EXPECT_TRUE(brdf->IsIsotropic()) << name;
  }
}

}  // namespace
}  // namespace pbnbrdf
