// The command eval: texts of directions in, the same with values out.
#include "cli/cli_fixture.h"

namespace pbnbrdf {
namespace {

TEST_F(Cli, EvalAppendsToWhatItReads) {
  WriteBytes(Path("pairs.csv"), "name,theta_i,phi_i,theta_o,phi_o\na,0.3,0,0.5,1\nb,0.3,0,2,1\n");
  ASSERT_EQ(Run("eval --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                " --out=" + Path("values.csv"))
                .status,
            0);
  const std::string f = FormatFullPrecision(0.99 / kPi);
  EXPECT_EQ(ReadFile(Path("values.csv"), 1 << 20),
            StrCat("name,theta_i,phi_i,theta_o,phi_o,r,g,b\na,0.3,0,0.5,1,", f, ",", f, ",", f,
                   "\nb,0.3,0,2,1,0,0,0\n"));
}

TEST_F(Cli, EvalTakesVectorsFromStandardInput) {
  const Result result =
      Run("eval --material=builtin:spectralon --directions=- --out=- <<'END'\n"
          "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,2,1,0,1\nEND\n");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("0,0,2,1,0,1," + FormatFullPrecision(0.99 / kPi)));
}

TEST_F(Cli, EvalTakesTheDialectsOfText) {
  const std::string f = FormatFullPrecision(0.99 / kPi);
  const auto values = [&](const std::string& csv) {
    WriteBytes(Path("pairs.csv"), csv);
    return Run("eval --material=builtin:spectralon --out=- --directions=" + Path("pairs.csv"));
  };
  EXPECT_EQ(values("\xef\xbb\xbfTheta_I;phi_i;theta_o;phi_o\r\n# why\r\n0.3;0;-0.5;1").out,
            StrCat("Theta_I;phi_i;theta_o;phi_o;r;g;b\n0.3;0;-0.5;1;", f, ";", f, ";", f, "\n"));
  EXPECT_EQ(values("# theta_i phi_i theta_o phi_o\n0 0 0.5 1\n").out,
            StrCat("# theta_i phi_i theta_o phi_o r g b\n0 0 0.5 1 ", f, " ", f, " ", f, "\n"));
  const Result tabs =
      values("theta_i\tphi_i\ttheta_o\tphi_o\tnote\n0\t0\t0\t0\t\n0\tnan\t0\t0\tx\n");
  EXPECT_EQ(tabs.out, StrCat("theta_i\tphi_i\ttheta_o\tphi_o\tnote\tr\tg\tb\n0\t0\t0\t0\t\t", f,
                             "\t", f, "\t", f, "\n"));
  EXPECT_EQ(tabs.err, "pbnbrdf: 1 rows that lack a direction are left out\n");
}

TEST_F(Cli, EvalReadsDirectionsOfOtherPrograms) {
  PBNBRDF_REFERENCE_FILE(folder, "faults/directions_csv");
  const auto rows = [&](const std::string& csv) {
    const Result result =
        Run("eval --material=builtin:satin-gold --out=- --directions='" + csv + "'");
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> values;
    for (const std::string& row : Split(result.out, '\n')) {
      const std::vector<std::string> cells = Split(row, ',');
      if (cells.size() == 7) values.push_back(cells[4]);
    }
    return values;
  };
  WriteBytes(Path("radians.csv"),
             StrCat("theta_i,phi_i,theta_o,phi_o\n", kPi / 4, ",0,", kPi / 6, ",", kPi, "\n",
                    kPi / 3, ",0,", kPi / 4, ",", kPi / 2, "\n"));
  const auto radians = rows(Path("radians.csv")), degrees = rows(folder + "/deg_columns.csv");
  ASSERT_EQ(degrees.size(), 3u);
  for (int k : {1, 2}) {
    EXPECT_NEAR(ParseNumber("r", degrees[k]), ParseNumber("r", radians[k]), 1e-4) << k;
  }
  EXPECT_EQ(rows(folder + "/q_bom.csv").size(), 2u);
  const auto signed_theta = rows(folder + "/q_negtheta.csv");
  EXPECT_NEAR(ParseNumber("r", signed_theta[1]), ParseNumber("r", signed_theta[2]), 1e-9);
  ExpectError("eval --material=builtin:satin-gold --out=- --directions='" + folder +
                  "/deg_in_rad_columns.csv'",
              1, "theta_i is 45 radians");
}

TEST_F(Cli, BadDirectionsAreNamed) {
  const auto values = [&](const std::string& csv, const std::string& message) {
    WriteBytes(Path("pairs.csv"), csv);
    ExpectError("eval --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                    " --out=" + Path("out"),
                1, message);
  };
  values("", "pairs.csv: the first line must name the columns theta_i,phi_i,theta_o,phi_o");
  values("theta_i,phi_i,theta_o\n", "the first line must name the columns");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3\n", "line 2: 3 columns, expected 4");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n\n1,2,x,4\n",
         "line 4, theta_o: 'x' is not a finite");
  values("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0,0,0,1\n", "line 2: a direction has no length");
  values("theta_i,phi_i,theta_o,phi_o\n45,0,30,180\n",
         "line 2: theta_i is 45 radians; must be -3.14159 to 3.14159 (theta_i is in radians, "
         "theta_i_deg");
  values("theta_i,phi_i,theta_o,phi_o,R,g,b\n0,0,0,0,1,1,1\n",
         "line 1: there is a column r already; r,g,b are what is appended");
  values("theta_i,phi_i,theta_o,phi_o,phi_o\n", "two columns have the name phi_o");
  values("theta_i_deg,phi_i,theta_o,phi_o\n", "phi_i in radians and theta_i_deg in degrees");
  values("theta_i;phi_i;theta_o;phi_o\n0,1;0;0;0\n", "theta_i: '0,1' has a decimal comma");
  values(std::string("\xff\xfet\0", 4), "pairs.csv: UTF-16 text");
}

}  // namespace
}  // namespace pbnbrdf
