#include "pbnbrdf/sources/zemax.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/angles.h"
#include "sources/cie.h"
#include "sources/make_scattered.h"
#include "sources/text_words.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kMaxAngles = 100000;
constexpr std::size_t kMinKeywords = 2;  // by which a file is recognised
constexpr std::string_view kKeywords[] = {"source",         "symmetry",       "spectralcontent",
                                          "scattertype",    "samplerotation", "angleofincidence",
                                          "scatterazimuth", "scatterradial"};

struct Layout {
  bool plane_symmetrical = false, xyz = false;
  std::vector<double> rotations, incidences, azimuths, radials;  // radians
};

// A list of angles behind its count, each within +- `most` degrees.
std::vector<double> ReadAngles(TextWords* words, const std::string& keyword, double most) {
  std::vector<double> angles =
      words->NextNumbers(words->NextCount(kMaxAngles, keyword), "the angles of " + keyword);
  for (double& angle : angles) {
    if (!(std::abs(angle) <= most)) {
      Fail(words->Place(), ": ", keyword, ": ", angle, " degrees; must be up to ", most);
    }
    angle *= kDegree;
  }
  return angles;
}

// The word behind a keyword, one of those that are allowed.
std::string ReadChoice(TextWords* words, const std::string& keyword,
                       std::initializer_list<std::string_view> choices) {
  std::string word = LowerCase(words->NextWord(keyword));
  if (std::find(choices.begin(), choices.end(), word) != choices.end()) return word;
  std::string names;
  for (std::string_view choice : choices) names += StrCat(names.empty() ? "" : " | ", choice);
  Fail(words->Place(), ": ", keyword, " ", words->word(), " is not one of ", names);
}

void CheckScatterType(TextWords* words) {
  if (ReadChoice(words, "ScatterType", {"brdf", "btdf"}) == "btdf") {
    Fail(words->Place(), ": ScatterType BTDF: a transmission; only a BRDF is read");
  }
}

void TakeKeyword(TextWords* words, const std::string& keyword, Layout* layout) {
  if (keyword == "source") {
    words->NextWord(keyword);
  } else if (keyword == "symmetry") {
    layout->plane_symmetrical =
        ReadChoice(words, "Symmetry", {"planesymmetrical", "asymmetrical", "asymmetrical4d"}) ==
        "planesymmetrical";
  } else if (keyword == "spectralcontent") {
    layout->xyz = ReadChoice(words, "SpectralContent", {"monochrome", "xyz"}) == "xyz";
  } else if (keyword == "scattertype") {
    CheckScatterType(words);
  } else if (keyword == "samplerotation") {
    layout->rotations = ReadAngles(words, "SampleRotation", 360.0);
  } else if (keyword == "angleofincidence") {
    layout->incidences = ReadAngles(words, "AngleOfIncidence", 90.0);
  } else if (keyword == "scatterazimuth") {
    layout->azimuths = ReadAngles(words, "ScatterAzimuth", 360.0);
  } else if (keyword == "scatterradial") {
    layout->radials = ReadAngles(words, "ScatterRadial", 180.0);
  } else {
    Fail(words->Place(), ": '", words->word(), "' is not a keyword of a Zemax BSDF file");
  }
}

// Up to the first word of the data.
Layout ReadHeader(const std::string& path, TextWords* words) {
  Layout layout;
  while (true) {
    const std::string keyword = LowerCase(words->NextWord("its data"));
    if (keyword == "monochrome" || keyword == "tristimulusx") break;
    TakeKeyword(words, keyword, &layout);
  }
  if (layout.rotations.empty()) layout.rotations = {0.0};
  if (layout.incidences.empty() || layout.azimuths.empty() || layout.radials.empty()) {
    Fail(path, ": lacks one of AngleOfIncidence, ScatterAzimuth and ScatterRadial");
  }
  return layout;
}

// Goes to the number behind the next TIS.
void GoToBlock(TextWords* words) {
  constexpr std::string_view kMarks[] = {"databegin", "dataend", "tristimulusy", "tristimulusz"};
  std::string word = LowerCase(words->NextWord("all of its data"));
  while (std::find(std::begin(kMarks), std::end(kMarks), word) != std::end(kMarks)) {
    word = LowerCase(words->NextWord("all of its data"));
  }
  if (word != "tis") Fail(words->Place(), ": '", words->word(), "' where TIS was expected");
  words->NextNumber("TIS");
}

// [channel][rotation][incidence][azimuth][radial]
std::vector<double> ReadValues(const Layout& layout, TextWords* words) {
  const std::size_t blocks =
      (layout.xyz ? 3 : 1) * layout.rotations.size() * layout.incidences.size();
  const std::size_t size = layout.azimuths.size() * layout.radials.size();
  std::vector<double> values;
  for (std::size_t block = 0; block < blocks; ++block) {
    GoToBlock(words);
    const std::vector<double> numbers = words->NextNumbers(size, "all of its data");
    values.insert(values.end(), numbers.begin(), numbers.end());
  }
  if (LowerCase(words->NextWord("DataEnd")) != "dataend" || words->Next()) {
    Fail(words->Place(), ": '", words->word(), "' behind the data of all angles");
  }
  return values;
}

// Turned by an angle about the normal.
Vec3 Turned(const Vec3& w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

DirectionPair PairAt(double rotation, double incidence, double azimuth, double radial) {
  const double sin_i = std::sin(incidence), cos_i = std::cos(incidence);
  const Vec3 s = FromSpherical(radial, azimuth);
  const Vec3 wo = {-s.x * cos_i + s.z * sin_i, s.y, s.x * sin_i + s.z * cos_i};
  return {Turned({-sin_i, 0.0, cos_i}, rotation), Turned(wo, rotation)};
}

// Whether an azimuth and a radial angle are the same direction as those before.
bool IsRepeated(const Layout& layout, std::size_t azimuth, std::size_t radial) {
  if (azimuth == 0) return false;
  const double turn = layout.azimuths[azimuth] - layout.azimuths[0];
  return layout.radials[radial] == 0.0 || std::abs(turn) > 2.0 * std::numbers::pi - kDegree / 100;
}

ScatteredData Arrange(const Layout& layout, const std::vector<double>& values) {
  ScatteredData data;
  const std::size_t channels = layout.xyz ? 3 : 1, size = values.size() / channels;
  const std::vector<Rgb> weights = layout.xyz ? XyzToRgb() : std::vector<Rgb>{{1.0, 1.0, 1.0}};
  std::vector<double> value(channels);
  std::size_t at = 0;
  for (double rotation : layout.rotations) {
    for (double incidence : layout.incidences) {
      for (std::size_t a = 0; a < layout.azimuths.size(); ++a) {
        for (std::size_t r = 0; r < layout.radials.size(); ++r, ++at) {
          if (IsRepeated(layout, a, r)) continue;
          for (std::size_t c = 0; c < channels; ++c) value[c] = values[c * size + at];
          if (std::all_of(value.begin(), value.end(), [](double v) { return v == 0.0; })) {
            ++data.left_out;
            continue;
          }
          const Rgb f = WeightedSum(weights, value);
          const double azimuth = layout.azimuths[a], radial = layout.radials[r];
          data.samples.push_back({PairAt(rotation, incidence, azimuth, radial), f});
          // The mirror image; that of an isotropic material goes without saying.
          if (!layout.plane_symmetrical || layout.rotations.size() == 1) continue;
          data.samples.push_back({PairAt(rotation, incidence, -azimuth, radial), f});
        }
      }
    }
  }
  return data;
}

}  // namespace

bool LooksLikeZemax(std::string_view start) {
  std::size_t keywords = 0;
  for (const std::string& line : Split(start, '\n')) {
    const std::string word = LowerCase(line.substr(0, line.find_first_of(" \t")));
    keywords += std::find(std::begin(kKeywords), std::end(kKeywords), word) != std::end(kKeywords);
  }
  return keywords >= kMinKeywords;
}

ScatteredBrdf ReadZemax(const std::string& path) {
  TextWords words(TextTable::Read(path, TextTable::Cells::kBlanks));
  const Layout layout = ReadHeader(path, &words);
  ScatteredData data = Arrange(layout, ReadValues(layout, &words));
  data.kind = "Zemax measurements";
  data.channels = layout.xyz ? 3 : 1;
  data.isotropic = HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
