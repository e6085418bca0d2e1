#include "pbnbrdf/models/sgd.h"

#include <algorithm>
#include <bitset>
#include <numbers>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uintmax_t kLargestTable = 16 << 20;
constexpr std::string_view kHeader =
    "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error";
constexpr std::size_t kColumns = 15;

double Fresnel(const SgdParameters& m, double u) {
  return m.f0 + (1.0 - m.f0) * std::pow(1.0 - u, 5) - m.f1 * u;
}

double Distribution(const SgdParameters& m, double tan2, double cos2) {
  const double x = m.alpha + tan2 / m.alpha;
  return m.kappa * std::exp(-x) / (kPi * std::pow(x, m.p) * cos2 * cos2);
}

double Shadowing(const SgdParameters& m, double theta) {
  const double excess = theta - m.theta_0;
  if (excess <= 0.0) return 1.0;
  return std::clamp(1.0 + m.lambda * (1.0 - std::exp(m.c * std::pow(excess, m.k))), 0.0, 1.0);
}

SgdParameters ParseRow(const std::string& place, const std::vector<std::string>& row) {
  const auto number = [&](std::size_t column) {
    return ParseNumber(StrCat(place, ", column ", column + 1), row[column]);
  };
  const SgdParameters m = {.rho_d = number(3),
                           .rho_s = number(4),
                           .alpha = number(5),
                           .p = number(6),
                           .f0 = number(7),
                           .f1 = number(8),
                           .kappa = number(9),
                           .lambda = number(10),
                           .c = number(11),
                           .k = number(12),
                           .theta_0 = number(13)};
  if (!(m.alpha > 0.0)) Fail(place, ": alpha = ", m.alpha, "; must be > 0");
  return m;
}

}  // namespace

SgdBrdf SgdBrdf::Read(const std::string& path, const std::string& material) {
  std::istringstream in(ReadFile(path, kLargestTable));
  std::string line;
  if (!std::getline(in, line) || Trim(line) != kHeader) {
    Fail(path, ": not a table of SGD parameters: the first line must be ", kHeader);
  }
  std::array<SgdParameters, 3> channels;
  std::bitset<3> found;
  for (int number = 2; std::getline(in, line); ++number) {
    const std::vector<std::string> row = Split(line, ',');
    if (row[0] != material && (row.size() < 2 || row[1] != material)) continue;
    const std::string place = StrCat(path, ": line ", number);
    if (row.size() != kColumns) {
      Fail(place, ": ", row.size(), " columns, expected ", kColumns);
    }
    const std::size_t channel = std::string_view("rgb").find(row[2]);
    if (row[2].size() != 1 || channel == std::string_view::npos) {
      Fail(place, ": channel '", row[2], "' is not one of r | g | b");
    }
    channels[channel] = ParseRow(place, row);
    found.set(channel);
  }
  if (found.none()) Fail(path, ": no material '", material, "' in it");
  if (!found.all()) Fail(path, ": material '", material, "' lacks a channel of r, g, b");
  return SgdBrdf(material, channels);
}

std::string SgdBrdf::Description() const {
  return StrCat("SGD model of ", name_, " (Bagher et al. 2012)");
}

Rgb SgdBrdf::Value(const DirectionPair& pair) const {
  const auto& [wi, wo] = pair;
  const Vec3 sum = wi + wo;
  const double length = Length(sum);
  // tan^2 from the unnormalised half vector: 1 - cos^2 would lose the digits of narrow lobes.
  const double tan2 = (sum.x * sum.x + sum.y * sum.y) / (sum.z * sum.z);
  const double cos_h = sum.z / length;
  const double u = std::min(0.5 * length, 1.0);
  const double theta_i = std::acos(std::min(wi.z, 1.0));
  const double theta_o = std::acos(std::min(wo.z, 1.0));
  Rgb value;
  for (int c = 0; c < 3; ++c) {
    const SgdParameters& m = channels_[c];
    const double shadowing = Shadowing(m, theta_i) * Shadowing(m, theta_o);
    const double specular =
        Fresnel(m, u) * Distribution(m, tan2, cos_h * cos_h) * shadowing / (wi.z * wo.z);
    value[c] = (m.rho_d + m.rho_s * specular) / kPi;
  }
  return value;
}

}  // namespace pbnbrdf
