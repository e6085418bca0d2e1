#include "extreme_materials.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "base/pi.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/merl.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = kPi / 180.0;

using ValueOf = std::function<Rgb(const DirectionPair&)>;
using Known = std::function<bool(const RusinkiewiczAngles&)>;

// A formula, and where it counts as measured.
class FormulaBrdf final : public PointwiseBrdf {
 public:
  FormulaBrdf(std::string name, ValueOf value, Known known = {})
      : name_(std::move(name)), value_(std::move(value)), known_(std::move(known)) {}

  bool IsKnown(const DirectionPair& pair) const override {
    return pair.AboveHorizon() && (!known_ || known_(ToAngles(pair)));
  }
  std::string Description() const override { return "extreme material " + name_; }

 protected:
  Rgb Value(const DirectionPair& pair) const override { return value_(pair); }

 private:
  std::string name_;
  ValueOf value_;
  Known known_;
};

std::unique_ptr<Brdf> Constant(const char* name, const Rgb& value) {
  return std::make_unique<FormulaBrdf>(name, [value](const DirectionPair&) { return value; });
}

// `width`: of the lobe's slopes.
std::unique_ptr<Brdf> Peak(const char* name, double height, double width) {
  return std::make_unique<FormulaBrdf>(name, [=](const DirectionPair& pair) {
    const double slope = std::tan(ToAngles(pair).theta_h) / width;
    const double lobe = height * std::exp(-slope * slope);
    return Rgb{0.05 + lobe, 0.02 + lobe, lobe};
  });
}

// Jumps between 0 and 100 every ten degrees of theta_d.
std::unique_ptr<Brdf> Steps() {
  return std::make_unique<FormulaBrdf>("steps", [](const DirectionPair& pair) {
    const bool odd = static_cast<int>(ToAngles(pair).theta_d / (10.0 * kDegree)) % 2 == 1;
    return odd ? Rgb{100.0, 0.0, 1.0} : Rgb{0.0, 100.0, 1.0};
  });
}

std::unique_ptr<Brdf> Gold(const char* name, Known known) {
  const std::shared_ptr<Brdf> gold = MakeBuiltin("satin-gold");
  const auto value = [gold](const DirectionPair& pair) {
    Rgb f;
    gold->Evaluate({&pair, 1}, {&f, 1});
    return f;
  };
  return std::make_unique<FormulaBrdf>(name, value, std::move(known));
}

// The bin of a MERL table, phi_d and phi_d + pi being the same.
std::uint64_t MerlBin(const RusinkiewiczAngles& angles) {
  const auto floored = [](double x) { return static_cast<std::uint64_t>(x); };
  return (floored(MerlBrdf::kThetaH * std::sqrt(angles.theta_h / (0.5 * kPi))) * MerlBrdf::kThetaD +
          floored(MerlBrdf::kThetaD * angles.theta_d / (0.5 * kPi))) *
             MerlBrdf::kPhiD +
         floored(MerlBrdf::kPhiD * angles.phi_d / kPi) % MerlBrdf::kPhiD;
}

// A bin in a hundred, at random (Fibonacci hashing of its number).
bool IsInRareBin(const RusinkiewiczAngles& angles) {
  return (MerlBin(angles) * 0x9e3779b97f4a7c15 >> 32) % 100 == 0;
}

bool IsInOneBin(const RusinkiewiczAngles& angles) {
  return MerlBin(angles) == (45 * MerlBrdf::kThetaD + 20) * MerlBrdf::kPhiD + 60;
}

bool IsInSpot(const RusinkiewiczAngles& angles) {
  return std::abs(angles.theta_h - 30.0 * kDegree) < 4.0 * kDegree &&
         std::abs(angles.theta_d - 30.0 * kDegree) < 4.0 * kDegree;
}

bool IsGrazing(const RusinkiewiczAngles& angles) {
  const DirectionPair pair = FromAngles(angles);
  return std::min(pair.wi.z, pair.wo.z) < std::cos(85.0 * kDegree);
}

constexpr ExtremeMaterial kMaterials[] = {
    {"black", [] { return Constant("black", {}); }},
    {"constant",
     [] {
       return Constant("constant", {0.1, 0.2, 0.3});
     }},
    {"albedo_50",
     [] {
       return Constant("albedo_50", {50.0 / kPi, 50.0 / kPi, 50.0 / kPi});
     }},
    {"largest_value",
     [] {
       return Constant("largest_value", {1e12, 1e12, 1e12});
     }},
    {"peak_1e6", [] { return Peak("peak_1e6", 1e6, 0.01); }},
    {"needle_1e6", [] { return Peak("needle_1e6", 1e6, 1e-4); }},
    {"steps", [] { return Steps(); }},
    {"rare_bins", [] { return Gold("rare_bins", IsInRareBin); }},
    {"one_bin", [] { return Gold("one_bin", IsInOneBin); }},
    {"spot", [] { return Gold("spot", IsInSpot); }},
    {"grazing", [] { return Gold("grazing", IsGrazing); }},
    {"nowhere", [] { return Gold("nowhere", [](const RusinkiewiczAngles&) { return false; }); }},
};

}  // namespace

std::span<const ExtremeMaterial> ExtremeMaterials() { return kMaterials; }

std::unique_ptr<Brdf> MakeExtremeOrBuiltin(std::string_view name) {
  for (const ExtremeMaterial& material : kMaterials) {
    if (material.name == name) return material.make();
  }
  return MakeBuiltin(name);
}

}  // namespace pbnbrdf
