// The simple measures against values worked out by hand, all of them on equal images and their
// symmetries, and what isn't comparable. Other packages' values: interop/image_test.py.
#include "pbnbrdf/metrics/image_metrics.h"

#include <limits>

#include "image/images.h"
#include "image/srgb.h"
#include "pbnbrdf/metrics/color.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A ramp with noise and a highlight far above 1.
Image Scene(int width, int height, unsigned seed) {
  Image image = RandomImage(width, height, 0.0, 0.1, seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double r2 = std::pow(x - 0.3 * width, 2) + std::pow(y - 0.4 * height, 2);
      for (int c = 0; c < 3; ++c) {
        image.pixel(x, y)[c] += float(0.2 * (c + 1) * x / width + 20.0 * std::exp(-r2 / 8.0));
      }
    }
  }
  return image;
}

TEST(LinearErrors, ByHand) {
  Image reference(2, 1), test(2, 1);
  reference.rgb = {1, 2, 3, 4, 5, 100};
  test.rgb = {1, 1, 5, 4, 5, 97};  // errors 0, 1, 2, 0, 0, 3
  const LinearErrors errors = MeasureLinearErrors(reference, test);
  EXPECT_DOUBLE_EQ(errors.mae, 1.0);
  EXPECT_DOUBLE_EQ(errors.mse, 14.0 / 6.0);
  EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(14.0 / 6.0));
  EXPECT_EQ(AbsoluteDifference(reference, test).rgb, (std::vector<float>{0, 1, 2, 0, 0, 3}));
}

TEST(DisplayExposure, MakesAllButAHundredthAtMostWhite) {
  Image image(200, 1);  // greys 1, 2, ..., 200, mixed
  for (int x = 0; x < 200; ++x) {
    for (int c = 0; c < 3; ++c) image.pixel(x, 0)[c] = float(1 + x * 77 % 200);
  }
  EXPECT_NEAR(DisplayExposure(image), 1.0 / 198.0, 1e-12);
}

TEST(DisplayExposure, OfFewLitPixelsAndOfNone) {
  Image image(20, 20);
  EXPECT_EQ(DisplayExposure(image), 1.0);
  std::fill_n(image.pixel(7, 3), 3, 4.0f);
  EXPECT_NEAR(DisplayExposure(image), 0.25, 1e-12);
  std::fill_n(image.pixel(7, 3), 3, -4.0f);
  EXPECT_EQ(DisplayExposure(image), 1.0);
}

TEST(DisplayImage, ExposesCutsAndEncodes) {
  Image image(1, 1);
  image.rgb = {-1.0f, 0.09f, 3.0f};
  EXPECT_EQ(DisplayImage(image, 2.0).rgb,
            (std::vector<float>{0.0f, float(ToSrgb(2.0 * double(0.09f))), 1.0f}));
}

TEST(Psnr, ByHand) {
  const Image black = ConstantImage(4, 4, 0, 0, 0), grey = ConstantImage(4, 4, 0.1f, 0.1f, 0.1f);
  EXPECT_NEAR(Psnr(black, grey), 20.0, 1e-6);
  EXPECT_NEAR(Psnr(black, ConstantImage(4, 4, 1, 1, 1)), 0.0, 1e-12);
  EXPECT_EQ(Psnr(grey, grey), kInfinity);
}

TEST(Ssim, OfConstantImagesIsItsLuminanceTerm) {
  // Without variance what is left is (2 x y + C1) / (x^2 + y^2 + C1), C1 = 1e-4.
  const Image x = ConstantImage(16, 12, 0.5f, 0.25f, 1.0f),
              y = ConstantImage(16, 12, 0.25f, 0.25f, 0.5f);
  const double red = (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4);
  const double blue = (2 * 1.0 * 0.5 + 1e-4) / (1.0 + 0.25 + 1e-4);
  EXPECT_NEAR(Ssim(x, y), (red + 1.0 + blue) / 3.0, 1e-12);
}

TEST(Ssim, OfOneWindowByTheDefinition) {
  // 11 x 11 pixels hold one window: weighted mean, variance and covariance in plain sums.
  const Image x = RandomImage(11, 11, 0.0, 1.0, 1), y = RandomImage(11, 11, 0.0, 1.0, 2);
  double total = 0.0;
  for (int c = 0; c < 3; ++c) {
    double w_sum = 0, mx = 0, my = 0;
    const auto weight = [](int u, int v) {
      return std::exp(-((u - 5) * (u - 5) + (v - 5) * (v - 5)) / (2 * 1.5 * 1.5));
    };
    for (int i = 0; i < 121; ++i) {
      const double w = weight(i % 11, i / 11);
      w_sum += w, mx += w * x.rgb[std::size_t(3 * i + c)], my += w * y.rgb[std::size_t(3 * i + c)];
    }
    mx /= w_sum, my /= w_sum;
    double vx = 0, vy = 0, covariance = 0;
    for (int i = 0; i < 121; ++i) {
      const double w = weight(i % 11, i / 11) / w_sum;
      const double dx = x.rgb[std::size_t(3 * i + c)] - mx, dy = y.rgb[std::size_t(3 * i + c)] - my;
      vx += w * dx * dx, vy += w * dy * dy, covariance += w * dx * dy;
    }
    total += (2 * mx * my + 1e-4) * (2 * covariance + 9e-4) /
             ((mx * mx + my * my + 1e-4) * (vx + vy + 9e-4));
  }
  EXPECT_NEAR(Ssim(x, y), total / 3.0, 1e-12);
}

TEST(CompareImages, EqualImages) {
  for (const Image& image : {Scene(40, 31, 1), Image(11, 11), ConstantImage(12, 13, 5, 0.1f, 9)}) {
    const ImageErrors errors = CompareImages(image, image);
    for (double zero :
         {errors.mae, errors.mse, errors.rmse, errors.flip, errors.hdr_flip, errors.delta_e_2000}) {
      EXPECT_EQ(zero, 0.0);
    }
    EXPECT_EQ(errors.psnr, kInfinity);
    EXPECT_NEAR(errors.ssim, 1.0, 1e-12);
  }
}

TEST(CompareImages, TakesEachMeasureAsDocumented) {
  const Image x = Scene(40, 31, 1), y = Scene(40, 31, 2);
  const ImageErrors errors = CompareImages(x, y);
  EXPECT_EQ(errors.exposure, DisplayExposure(x));
  const Image shown_x = DisplayImage(x, errors.exposure),
              shown_y = DisplayImage(y, errors.exposure);
  EXPECT_EQ(errors.psnr, Psnr(shown_x, shown_y));
  EXPECT_EQ(errors.ssim, Ssim(shown_x, shown_y));
  double delta_e = 0.0;
  for (std::size_t i = 0; i < x.rgb.size(); i += 3) {
    Rgb a, b;
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] = std::clamp(errors.exposure * x.rgb[i + c], 0.0, 1.0);
      b[c] = std::clamp(errors.exposure * y.rgb[i + c], 0.0, 1.0);
    }
    delta_e += DeltaE2000(ToLab(a), ToLab(b)) / double(x.rgb.size() / 3);
  }
  EXPECT_NEAR(errors.delta_e_2000, delta_e, 1e-5 * delta_e);
  EXPECT_GT(errors.delta_e_2000, 0.1);
}

TEST(CompareImages, SymmetricButForTheExposure) {
  // The same luminances in another order: both give the same exposures.
  const Image x = Scene(40, 30, 3);
  Image y(40, 30);
  for (int row = 0; row < 30; ++row) std::copy_n(x.pixel(0, row), 120, y.pixel(0, 29 - row));
  const ImageErrors xy = CompareImages(x, y), yx = CompareImages(y, x);
  EXPECT_EQ(xy.mae, yx.mae);
  EXPECT_EQ(xy.mse, yx.mse);
  EXPECT_EQ(xy.psnr, yx.psnr);
  EXPECT_NEAR(xy.ssim, yx.ssim, 1e-12);
  EXPECT_NEAR(xy.flip, yx.flip, 1e-12);
  EXPECT_NEAR(xy.hdr_flip, yx.hdr_flip, 1e-12);
  EXPECT_NEAR(xy.delta_e_2000, yx.delta_e_2000, 1e-12);
  EXPECT_GT(xy.flip, 0.0);
}

TEST(CompareImages, ShownMeasuresDontDependOnTheUnitOfLight) {
  const Image x = Scene(32, 24, 4), y = Scene(32, 24, 5);
  Image x8 = x, y8 = y;
  for (float& value : x8.rgb) value *= 8.0f;
  for (float& value : y8.rgb) value *= 8.0f;
  const ImageErrors errors = CompareImages(x, y), scaled = CompareImages(x8, y8);
  EXPECT_NEAR(scaled.rmse, 8.0 * errors.rmse, 1e-12);
  EXPECT_NEAR(scaled.psnr, errors.psnr, 1e-9);
  EXPECT_NEAR(scaled.ssim, errors.ssim, 1e-9);
  EXPECT_NEAR(scaled.flip, errors.flip, 1e-9);
  EXPECT_NEAR(scaled.hdr_flip, errors.hdr_flip, 1e-9);
  EXPECT_NEAR(scaled.delta_e_2000, errors.delta_e_2000, 1e-9);
}

TEST(CompareImages, GrowWithTheError) {
  const Image reference = Scene(40, 30, 6), noise = RandomImage(40, 30, -0.1, 0.1, 7);
  ImageErrors last;
  last.psnr = kInfinity, last.ssim = 1.0;
  for (float amount : {0.2f, 0.6f, 2.0f}) {
    Image test = reference;
    for (std::size_t i = 0; i < test.rgb.size(); ++i) test.rgb[i] += amount * noise.rgb[i];
    const ImageErrors errors = CompareImages(reference, test);
    EXPECT_GT(errors.mae, last.mae);
    EXPECT_GT(errors.rmse, last.rmse);
    EXPECT_LT(errors.psnr, last.psnr);
    EXPECT_LT(errors.ssim, last.ssim);
    EXPECT_GT(errors.flip, last.flip);
    EXPECT_GT(errors.hdr_flip, last.hdr_flip);
    EXPECT_GT(errors.delta_e_2000, last.delta_e_2000);
    last = errors;
  }
}

TEST(CheckComparable, SaysWhatIsWrong) {
  const Image image(16, 16);
  const auto error = [](const Image& x, const Image& y) {
    return ErrorOf([&] { CompareImages(x, y); });
  };
  EXPECT_EQ(error(image, image), "");
  EXPECT_EQ(error(image, Image(16, 17)),
            "the test image: 16 x 17 pixels, but the reference has 16 x 16");
  EXPECT_THAT(error(Image(10, 16), Image(10, 16)), HasSubstr("SSIM needs at least 11 x 11"));
  EXPECT_NE(error(Image(), Image()), "");
  Image bad = image;
  bad.pixel(3, 9)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error(image, bad),
            "the test image: G of pixel (3, 9) is nan; finite values are needed");
  bad.pixel(3, 9)[1] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error(bad, image), HasSubstr("the reference: G of pixel (3, 9) is inf"));
}

TEST(CompareImages, ExtremeValuesStayNumbers) {
  const float most = std::numeric_limits<float>::max();
  const float least = std::numeric_limits<float>::denorm_min();
  const Image images[] = {ConstantImage(11, 11, most, most, most), Image(11, 11),
                          ConstantImage(11, 11, least, least, least),
                          ConstantImage(11, 11, -1.0f, 2.0f, -most)};
  for (const Image& x : images) {
    for (const Image& y : images) {
      const ImageErrors errors = CompareImages(x, y);
      for (double value : {errors.mae, errors.mse, errors.ssim, errors.flip, errors.hdr_flip,
                           errors.delta_e_2000}) {
        EXPECT_TRUE(std::isfinite(value));
      }
      EXPECT_FALSE(std::isnan(errors.psnr));
      EXPECT_LE(errors.hdr_flip, 1.0);
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
