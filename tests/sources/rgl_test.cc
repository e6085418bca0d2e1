#include "pbnbrdf/sources/rgl.h"

#include <algorithm>

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/rgl_writer.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kFiles = {"synth_plastic_rgb.bsdf", "synth_gold_rgb.bsdf",
                                         "synth_brushed_rgb.bsdf", "synth_satin_spec.bsdf"};

// A unit vector that went through single precision.
Vec3 Rounded(double theta, double phi) {
  const Vec3 w = FromSpherical(theta, phi);
  return {float(w.x), float(w.y), float(w.z)};
}

// The error as a part of what the oracle's single precision leaves; at most 1 is wanted.
double RelativeToTolerance(double value, double expected, const std::string& what) {
  const double part = std::abs(value - expected) / (1e-3 * std::abs(expected) + 1e-6);
  EXPECT_LE(part, 1.0) << what << ": " << value << ", expected " << expected;
  return part;
}

TEST(Rgl, AgreesWithTheReferenceLoader) {
  PBNBRDF_REFERENCE_FILE(csv, "rgl/values.csv");
  const std::string folder = csv.substr(0, csv.rfind('/') + 1);
  std::map<std::string, RglBrdf> materials;
  std::size_t values = 0, densities = 0;
  double worst_value = 0.0, worst_density = 0.0;
  for (const std::vector<std::string>& row : ReadCsvRows(csv)) {
    const auto number = [&](int column) { return ParseNumber("oracle", row[column]); };
    if (!materials.count(row[0])) materials.emplace(row[0], RglBrdf::Read(folder + row[0]));
    const RglBrdf& brdf = materials.at(row[0]);
    const DirectionPair pair = {Rounded(number(2), number(3)), Rounded(number(4), number(5))};
    const std::string what = StrCat(row[0], " ", row[1], " ", row[2], " ", row[4]);
    if (!row[6].empty()) {
      const double pdf = brdf.Pdf(pair.wi, pair.wo);
      worst_density = std::max(worst_density, RelativeToTolerance(pdf, number(6), what + " pdf"));
      ++densities;
    }
    const Rgb rgb = ValueAt(brdf, pair);
    const std::vector<double> found = brdf.wavelengths().empty()
                                          ? std::vector<double>(rgb.begin(), rgb.end())
                                          : brdf.Spectrum(pair);
    ASSERT_EQ(double(found.size()), number(7)) << what;
    for (std::size_t c = 0; c < found.size(); ++c) {
      const double value = found[c] * std::max(pair.wo.z, 0.0);
      worst_value = std::max(worst_value, RelativeToTolerance(value, number(8 + int(c)), what));
      ++values;
    }
  }
  EXPECT_EQ(values, 3 * 300u * 3 + 300u * 16);
  EXPECT_GT(densities, 1000u);
  RecordProperty("worst_value_over_tolerance", std::to_string(worst_value));
  RecordProperty("worst_density_over_tolerance", std::to_string(worst_density));
}

// Of incident directions and parts of the sphere, how many samples should fall and how many do.
void ExpectSamplesFollowPdf(const RglBrdf& brdf, const Vec3& wi, const std::string& what) {
  constexpr int kRows = 8, kColumns = 12, kFine = 24, kSamples = 100000;
  double expected[kRows * kColumns] = {}, chi2 = 0.0, total = 0.0;
  int found[kRows * kColumns] = {}, below = 0, bins = 0;
  const auto bin_of = [&](const Vec3& w) {  // equal areas
    const double phi = std::atan2(w.y, w.x) + kPi;
    return std::min(int(w.z * kRows), kRows - 1) * kColumns +
           std::min(int(phi / (2 * kPi) * kColumns), kColumns - 1);
  };
  const int rows = kRows * kFine, columns = kColumns * kFine;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const Vec3 wo =
          FromSpherical(std::acos((r + 0.5) / rows), 2 * kPi * (c + 0.5) / columns - kPi);
      const double mass = brdf.Pdf(wi, wo) * 2 * kPi / (rows * columns);
      expected[bin_of(wo)] += mass;
      total += mass;
    }
  }
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int n = 0; n < kSamples; ++n) {
    const double u0 = uniform(random), u1 = uniform(random);
    const Vec3 wo = brdf.Sample(wi, u0, u1);
    ASSERT_NEAR(Length(wo), 1.0, 1e-9) << what;
    if (wo.z > 0.0)
      ++found[bin_of(wo)];
    else
      ++below;
  }
  for (int k = 0; k < kRows * kColumns; ++k) {
    const double count = kSamples * expected[k];
    if (count < 20.0) continue;
    chi2 += (found[k] - count) * (found[k] - count) / count;
    ++bins;
  }
  ASSERT_GT(bins, 20) << what;
  // The mean of chi squared is its number of bins, its variance twice that.
  EXPECT_LT(chi2, bins + 5.0 * std::sqrt(2.0 * bins)) << what;
  EXPECT_NEAR(total, 1.0 - double(below) / kSamples, 0.01) << what;
}

TEST(Rgl, SamplesFollowTheDensity) {
  for (const char* name : {"synth_brushed_rgb.bsdf", "synth_satin_spec.bsdf"}) {
    PBNBRDF_REFERENCE_FILE(path, std::string("rgl/") + name);
    const RglBrdf brdf = RglBrdf::Read(path);
    for (double theta : {0.05, 0.7, 1.3}) {
      ExpectSamplesFollowPdf(brdf, FromSpherical(theta, 2.0), StrCat(name, " at ", theta));
    }
  }
}

TEST(Rgl, IsotropicFilesTurn) {
  for (const std::string& name : kFiles) {
    PBNBRDF_REFERENCE_FILE(path, "rgl/" + name);
    const RglBrdf brdf = RglBrdf::Read(path);
    EXPECT_EQ(brdf.IsIsotropic(), name != "synth_brushed_rgb.bsdf");
    double most = 0.0;
    for (const DirectionPair& pair : RandomPairs(200, 3)) {
      const double f = ValueAt(brdf, pair)[0], turned = ValueAt(brdf, Turned(pair, 1.0))[0];
      most = std::max(most, std::abs(f - turned) / (1e-3 + f));
    }
    EXPECT_EQ(most < 1e-4, brdf.IsIsotropic()) << name << " " << most;
  }
}

// Colours that depend on theta_i alone: value k at node k.
TensorWriter FileByAngle(const std::vector<float>& theta_i, const std::vector<float>& values) {
  TensorWriter file = ConstantFile(1, {0.0f, 0.0f, 0.0f});
  const std::uint64_t n = theta_i.size(), size = 3;
  std::vector<float> colors;
  for (float value : values) colors.insert(colors.end(), 3 * size * size, value);
  const std::vector<float> ones(n * size * size, 1.0f);
  return file.Replace("theta_i", {n}, theta_i)
      .Replace("vndf", {1, n, size, size}, ones)
      .Replace("luminance", {1, n, size, size}, ones)
      .Replace("rgb", {1, n, 3, size, size}, colors);
}

// f cos_o 4 sigma / D of a file by FileByAngle.
double TableValue(const Brdf& brdf, double theta_i) {
  const DirectionPair pair = {FromSpherical(theta_i, 0.3), FromSpherical(0.4, 2.0)};
  return ValueAt(brdf, pair)[1] * pair.wo.z * 4.0 * kPi;
}

class RglByAngle : public testing::Test {
 protected:
  RglByAngle() {
    WriteBytes(folder_ / "a.bsdf", FileByAngle(kAngles, kValues).Bytes());
    brdf_.emplace(RglBrdf::Read(folder_ / "a.bsdf"));
  }

  static inline const std::vector<float> kAngles = {0.0f, 0.4f, 0.7f, 1.0f, 1.3f, 1.5707f};
  static inline const std::vector<float> kValues = {0.5f, 0.2f, 0.25f, 0.9f, 1.5f, 3.0f};
  TemporaryFolder folder_;
  std::optional<RglBrdf> brdf_;
};

TEST_F(RglByAngle, TheBestEstimateGoesThroughTheNodesAndStaysBetweenThem) {
  const std::unique_ptr<Brdf> best = brdf_->BestEstimate(Brdf::Estimate::kLikeliest);
  double largest_difference = 0.0;
  for (std::size_t k = 0; k + 1 < kAngles.size(); ++k) {
    EXPECT_NEAR(TableValue(*best, kAngles[k]), kValues[k], 1e-4);
    double last = kValues[k];
    for (double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const double theta = kAngles[k] + t * (double(kAngles[k + 1]) - kAngles[k]);
      const double value = TableValue(*best, theta);
      EXPECT_GE((value - last) * (kValues[k + 1] - kValues[k]), -1e-6) << theta;
      EXPECT_LE(std::abs(value - kValues[k]), std::abs(kValues[k + 1] - kValues[k]) + 1e-4);
      last = value;
      largest_difference =
          std::max(largest_difference, std::abs(value - TableValue(*brdf_, theta)));
    }
  }
  EXPECT_GT(largest_difference, 0.02);
}

TEST_F(RglByAngle, AsStoredItIsWhatTheFormatSaysNearlyToTheHorizon) {
  const std::unique_ptr<Brdf> stored = brdf_->BestEstimate(Brdf::Estimate::kAsStored);
  for (double theta : {0.1, 0.4, 0.55, 1.2, 1.4}) {
    EXPECT_EQ(TableValue(*stored, theta), TableValue(*brdf_, theta)) << theta;
    EXPECT_EQ(stored->Certainty({FromSpherical(theta, 0.1), FromSpherical(0.3, 1.0)}), 1.0);
  }
  const DirectionPair grazing = {FromSpherical(1.55, 0.1), FromSpherical(1.55, 1.0)};
  EXPECT_FALSE(brdf_->IsKnown(grazing));
  EXPECT_TRUE(stored->IsKnown(grazing));
  EXPECT_FALSE(stored->NearestMeasured(grazing));
}

TEST_F(RglByAngle, CertaintyIsLargestAtMeasuredAngles) {
  const Vec3 wo = FromSpherical(0.4, 2.0);
  const auto at = [&](double theta) { return brdf_->Certainty({FromSpherical(theta, 0.1), wo}); };
  for (std::size_t k = 0; k + 1 < kAngles.size(); ++k) EXPECT_NEAR(at(kAngles[k]), 1.0, 1e-6);
  EXPECT_LT(at(0.55), at(0.5));
  EXPECT_NEAR(at(0.55), 1.0 / (1.0 + 3.85 * 3.85), 1e-6);
  EXPECT_LT(at(1.56), at(1.4)) << "nothing is measured at 90 degrees";
  const auto nearest = brdf_->NearestMeasured({FromSpherical(0.53, 0.1), wo});
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(std::acos(nearest->wi.z), 0.4, 1e-6);
  EXPECT_NEAR(std::atan2(nearest->wi.y, nearest->wi.x), 0.1, 1e-9);
  EXPECT_EQ(nearest->wo, wo);
}

TEST_F(RglByAngle, AnAngleCanBeLeftOut) {
  ASSERT_EQ(brdf_->IncidentAngles().size(), 5u);
  const std::unique_ptr<Brdf> rest = brdf_->WithoutIncidentAngle(2);
  EXPECT_EQ(rest->IncidentAngles().size(), 4u);
  for (double theta : {0.2, 0.4, 1.0, 1.2}) {
    EXPECT_NEAR(TableValue(*rest, theta), TableValue(*brdf_, theta), 1e-6) << theta;
  }
  EXPECT_NEAR(TableValue(*rest, 0.7), 0.55, 1e-4);
}

TEST(Rgl, AConstantFileIsWhatTheFormulaSays) {
  TemporaryFolder folder;
  for (std::uint64_t n_phi : {1, 5}) {
    WriteBytes(folder / "a.bsdf", ConstantFile(n_phi, {0.8f, 0.4f, -0.1f}).Bytes());
    const RglBrdf brdf = RglBrdf::Read(folder / "a.bsdf");
    EXPECT_EQ(brdf.IsIsotropic(), n_phi == 1);
    EXPECT_THAT(brdf.Description(), HasSubstr("RGB, "));
    EXPECT_THAT(brdf.Description(), HasSubstr(": test"));
    for (const DirectionPair& pair : HardAndRandomPairs(1000, 1)) {
      if (!pair.AboveHorizon()) continue;
      const Rgb value = ValueAt(brdf, pair);
      // c D / (4 sigma cos_o), and nothing below 0.
      ASSERT_NEAR(value[0] * pair.wo.z, 0.8 / (4 * kPi), 1e-7);
      ASSERT_NEAR(value[1] * pair.wo.z, 0.4 / (4 * kPi), 1e-7);
      ASSERT_EQ(value[2], 0.0);
      // The square's uniform density, as one by solid angle.
      const Vec3 h = pair.wi + pair.wo;
      const double length = Length(h), theta_h = std::acos(std::min(1.0, h.z / length));
      const double u = std::sqrt(2 * theta_h / kPi), sin_h = std::hypot(h.x, h.y) / length;
      const double pdf = 1.0 / (2.0 * length * std::max(2 * kPi * kPi * u * sin_h, 1e-6));
      ASSERT_NEAR(brdf.Pdf(pair.wi, pair.wo), pdf, 1e-5 * pdf);
    }
    const DirectionPair below = {{0, 0, 1}, {0.6, 0, -0.8}};
    EXPECT_EQ(ValueAt(brdf, below)[0], 0.0);
    EXPECT_EQ(brdf.Pdf(below.wi, below.wo), 0.0);
  }
}

TEST(Rgl, AConstantSpectrumIsGrey) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.bsdf", ConstantFile(1, std::vector<float>(16, 0.5f)).Bytes());
  const std::unique_ptr<Brdf> brdf = OpenBrdf(folder / "a.bsdf");
  EXPECT_THAT(brdf->Description(), HasSubstr("16 wavelengths from 400 to 700 nm"));
  for (const DirectionPair& pair : RandomPairs(100, 1)) {
    const Rgb value = ValueAt(*brdf, pair);
    ASSERT_NEAR(value[0] * pair.wo.z, 0.5 / (4 * kPi), 1e-7);
    ASSERT_NEAR(value[1], value[0], 1e-6 * value[0]);
    ASSERT_NEAR(value[2], value[0], 1e-6 * value[0]);
  }
}

// Up to the last theta_i, 1.4, wherever wi and wo are.
TEST(Rgl, IsKnownWhereItWasMeasured) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.bsdf", ConstantFile(1, {1, 1, 1}).Bytes());
  const RglBrdf brdf = RglBrdf::Read(folder / "a.bsdf");
  const Vec3 inside = FromSpherical(1.399, 0.3), beyond = FromSpherical(1.401, 1.0);
  EXPECT_TRUE(brdf.IsKnown({inside, inside}));
  EXPECT_FALSE(brdf.IsKnown({inside, beyond}));
  EXPECT_FALSE(brdf.IsKnown({beyond, inside}));
}

TEST(Rgl, OneWavelengthIsOneChannel) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.bsdf", ConstantFile(1, {0.5f}).Bytes());
  const RglBrdf brdf = RglBrdf::Read(folder / "a.bsdf");
  EXPECT_EQ(brdf.NumChannels(), 1);
  const Rgb value = ValueAt(brdf, {{0, 0, 1}, {0, 0, 1}});
  EXPECT_NEAR(value[0], 0.5 / (4 * kPi), 1e-7);
  EXPECT_EQ(value[2], value[0]);
}

TEST(Rgl, AFileIsKnownByItsContentToo) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.dat", ConstantFile(1, {1, 1, 1}).Bytes());
  EXPECT_THAT(OpenBrdf(folder / "a.dat")->Description(), HasSubstr("RGL measurement"));
}

TEST(Rgl, BadFilesAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "m.bsdf";
  const auto read = [&](const TensorWriter& file) {
    WriteBytes(path, file.Bytes());
    return ErrorOf([&] { RglBrdf::Read(path); });
  };
  const std::vector<float> grey(3, 0.5f);
  EXPECT_EQ(read(ConstantFile(1, grey)), "");
  // The writer's fields one after the other; each case is a copy with one field replaced.
  const auto with = [&](const std::string& name, const std::vector<std::uint64_t>& shape,
                        const std::vector<float>& values) {
    TensorWriter file = ConstantFile(1, grey);
    return read(file.Replace(name, shape, values));
  };
  EXPECT_THAT(with("theta_i", {2}, {0.5f, 0.1f}),
              HasSubstr("m.bsdf: element 1 of field 'theta_i' is 0.1; must ascend"));
  EXPECT_THAT(with("theta_i", {3}, {0.1f, 0.2f, 0.3f}),
              HasSubstr("field 'vndf' is 1 x 2 x 3 x 3, expected 1 x 3 x 3 x 3"));
  EXPECT_THAT(with("ndf", {4}, {1, 1, 1, 1}),
              HasSubstr("field 'ndf' is 4, expected 2 sizes, none of them 0"));
  EXPECT_THAT(with("ndf", {1, 4}, {1, 1, 1, 1}), HasSubstr("must be at least 2 x 2"));
  EXPECT_THAT(with("sigma", {2, 2}, {1, 1, -1, 1}),
              HasSubstr("element 2 of field 'sigma' is -1; must be >= 0"));
  EXPECT_THAT(with("sigma", {2, 2}, {1, std::nanf(""), 1, 1}),
              HasSubstr("element 1 of field 'sigma' is not a finite number"));
  EXPECT_THAT(read(ConstantFile(4, grey).Replace("phi_i", {4}, {-1, 0, 1, 2})),
              HasSubstr("its phi_i span 3 radians"));
  EXPECT_THAT(with("rgb", {1, 2, 1, 3, 3}, std::vector<float>(18)),
              HasSubstr("field 'rgb' is 1 x 2 x 1 x 3 x 3, expected 1 x 2 x 3 x 3 x 3"));
  EXPECT_THAT(read(ConstantFile(1, {0.5f, 0.5f})),
              HasSubstr("m.bsdf: wavelengths of 400 to 420 nm; a colour needs 430 to 660"));
  EXPECT_THAT(read(ConstantFile(1, grey).Remove("jacobian")), HasSubstr("no field 'jacobian'"));
  EXPECT_THAT(read(ConstantFile(1, grey).Remove("luminance")), HasSubstr("no field 'luminance'"));
}

// One part in a million of the largest, as in published files.
TEST(Rgl, NegativeRoundingIsZero) {
  TemporaryFolder folder;
  const std::string path = folder / "m.bsdf";
  const auto opened = [&](float negative) {
    TensorWriter file = ConstantFile(1, {1, 1, 1});
    WriteBytes(path, file.Replace("ndf", {2, 2}, {1.0f, negative, 1.0f, 2.0f}).Bytes());
    return OpenBrdf(path)->IsKnown({{0, 0, 1}, {0, 0, 1}});
  };
  EXPECT_TRUE(opened(-1.9e-6f));
  EXPECT_THAT(ErrorOf([&] { opened(-2.1e-6f); }),
              HasSubstr("of field 'ndf' is -2.1e-06; must be >= 0"));
}

TEST(Rgl, EveryMeasuredFileIsRead) {
  PBNBRDF_REFERENCE_FILE(folder, "measured/rgl");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_THAT(OpenBrdf(entry.path())->Description(),
                HasSubstr("RGL measurement, isotropic, RGB"));
    ++files;
  }
  EXPECT_EQ(files, 13);
}

TEST(Rgl, TheCorruptFilesAreRefused) {
  PBNBRDF_REFERENCE_FILE(folder, "rgl/corrupt");
  const auto error = [&](const std::string& name) {
    return ErrorOf([&] { OpenBrdf(folder + "/" + name); });
  };
  EXPECT_THAT(error("wrong_magic.bsdf"), HasSubstr("wrong_magic.bsdf: not a tensor file"));
  EXPECT_THAT(error("truncated.bsdf"),
              HasSubstr("truncated.bsdf: truncated or damaged: field 'rgb'"));
  EXPECT_THAT(error("bad_shape.bsdf"), HasSubstr("bad_shape.bsdf: field 'vndf' is 1 x 5"));
}

// Every 1/20 of a file's length, and each of its first bytes.
TEST(Rgl, TruncationsAreRefused) {
  TemporaryFolder folder;
  const std::string path = folder / "m.bsdf", good = ConstantFile(1, {1, 1, 1}).Bytes();
  const auto refused = [&](std::size_t length) {
    WriteBytes(path, good.substr(0, length));
    EXPECT_THAT(ErrorOf([&] { RglBrdf::Read(path); }), testing::StartsWith(path + ": ")) << length;
  };
  for (std::size_t k = 0; k < 20; ++k) refused(good.size() * k / 20);
  for (std::size_t length = 0; length < 400; ++length) refused(length);
}

}  // namespace
}  // namespace pbnbrdf
