#include "pbnbrdf/sources/cornell.h"

#include "pbnbrdf/base/error.h"
#include "sources/angles.h"
#include "sources/cie.h"
#include "sources/make_scattered.h"
#include "sources/text_words.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kMaxWavelengths = 10000;
constexpr double kMinWavelength = 200.0, kMaxWavelength = 20000.0;  // nm

std::vector<float> ReadWavelengths(TextWords* words) {
  const std::size_t count = words->NextCount(kMaxWavelengths, "the number of wavelengths");
  std::vector<float> wavelengths;
  while (wavelengths.size() < count) {
    const double least = wavelengths.empty() ? kMinWavelength : wavelengths.back();
    const double wavelength = words->NextNumber("all wavelengths");
    if (!(wavelength >= least && wavelength <= kMaxWavelength)) {
      Fail(words->Place(), ": a wavelength of ", wavelength, " nm; must ascend from ",
           kMinWavelength, " to ", kMaxWavelength);
    }
    wavelengths.push_back(static_cast<float>(wavelength));
  }
  return wavelengths;
}

// Of the row that the current word begins.
BrdfSample ParseRow(TextWords* words, std::span<const Rgb> weights) {
  const std::string place = words->Place();
  const double theta_i = words->Number();
  const std::vector<double> others = words->NextNumbers(3, "the angles of a row");
  BrdfSample sample;
  sample.pair = PairFromAngles(place, {theta_i, others[0], others[1], others[2]});
  sample.value = WeightedSum(weights, words->NextNumbers(weights.size(), "the spectrum of a row"));
  return sample;
}

}  // namespace

bool LooksLikeCornell(std::string_view start) {
  try {
    TextWords words(TextTable("", std::string(start), TextTable::Cells::kBlanks));
    return !ReadWavelengths(&words).empty();
  } catch (const Error&) {
    return false;
  }
}

ScatteredBrdf ReadCornell(const std::string& path) {
  TextWords words(TextTable::Read(path, TextTable::Cells::kBlanks));
  const std::vector<float> wavelengths = ReadWavelengths(&words);
  const std::vector<Rgb> weights = SpectrumToRgb(path, wavelengths);
  ScatteredData data;
  while (words.Next()) data.samples.push_back(ParseRow(&words, weights));
  data.kind = StrCat("Cornell measurements at ", wavelengths.size(), " wavelengths");
  data.channels = wavelengths.size() == 1 ? 1 : 3;
  data.isotropic = HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
