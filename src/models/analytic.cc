#include "pbnbrdf/models/analytic.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/text.h"
#include "models/analytic_formulas.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

template <typename Formula>
constexpr AnalyticModel ModelOf() {
  return {Formula::kName, Formula::kPaper, Formula::kBase, Formula::kLobe,
          EvaluateFormula<Formula, double>};
}

template <std::size_t... I>
constexpr auto AllModels(std::index_sequence<I...>) {
  return std::array{ModelOf<std::tuple_element_t<I, AnalyticFormulas>>()...};
}

constexpr auto kModels = AllModels(std::make_index_sequence<std::tuple_size_v<AnalyticFormulas>>());

std::size_t NumScalars(const AnalyticModel& model, int lobes) {
  return static_cast<std::size_t>(model.BaseSize() + lobes * model.LobeSize());
}

std::string Suffix(int lobe) { return lobe == 0 ? "" : StrCat("_", lobe + 1); }

std::vector<std::string> ModelNames() {
  std::vector<std::string> names;
  for (const AnalyticModel& model : kModels) names.emplace_back(model.name);
  return names;
}

// 0 if the model has none; else as many as the names ask for.
int LobesOf(const AnalyticModel& model, const AnalyticBrdf::Values& values) {
  if (model.lobe.empty()) return 0;
  const bool two = std::any_of(values.begin(), values.end(),
                               [](const auto& value) { return value.first.ends_with("_2"); });
  return two ? 2 : 1;
}

// The names of parameters, and the places that each sets: one, or two that are a pair.
std::vector<std::pair<std::string, std::vector<PlacedParameter>>> PlacesByName(
    const std::vector<PlacedParameter>& all) {
  std::vector<std::pair<std::string, std::vector<PlacedParameter>>> places;
  for (std::size_t i = 0; i < all.size(); ++i) {
    places.push_back({all[i].Name(), {all[i]}});
    const std::string_view pair_name = all[i].parameter->pair_name;
    if (pair_name.empty()) continue;
    places.push_back({StrCat(pair_name, Suffix(all[i].lobe)), {all[i - 1], all[i]}});
  }
  return places;
}

void SetScalars(const std::string& name, const std::vector<double>& values,
                const PlacedParameter& placed, std::vector<double>* scalars) {
  const std::size_t size = static_cast<std::size_t>(placed.parameter->size);
  if (values.size() != size && values.size() != 1) {
    Fail(name, ": ", values.size(), " numbers, expected ", size == 1 ? "1" : "1 or 3");
  }
  for (std::size_t c = 0; c < size; ++c) {
    (*scalars)[placed.first + c] = values[values.size() == 1 ? 0 : c];
  }
}

template <typename Format>
std::string TextOf(const AnalyticModel& model,
                   const std::vector<std::pair<std::string, std::vector<double>>>& named,
                   Format format) {
  std::string text;
  for (const auto& [name, values] : named) {
    text += (text.empty() ? "" : ",") + name + "=";
    const bool all_equal = std::count(values.begin(), values.end(), values[0]) ==
                           static_cast<std::ptrdiff_t>(values.size());
    for (std::size_t c = 0; c < (all_equal ? 1 : values.size()); ++c) {
      text.append(c == 0 ? "" : "/").append(format(values[c]));
    }
  }
  return StrCat(model.name, ":", text);
}

std::string Show(const Rgb& rgb) { return StrCat("(", rgb[0], ", ", rgb[1], ", ", rgb[2], ")"); }

}  // namespace

int AnalyticModel::BaseSize() const { return SizeOf(base); }
int AnalyticModel::LobeSize() const { return SizeOf(lobe); }

std::span<const AnalyticModel> AnalyticModels() { return kModels; }

const AnalyticModel& FindAnalyticModel(std::string_view name) {
  for (const AnalyticModel& model : kModels) {
    if (model.name == name) return model;
  }
  const std::vector<std::string> names = ModelNames();
  Fail("model '", name, "' is unknown; did you mean ", Nearest(names, std::string(name)),
       "? There are ", Join(names, ", "));
}

bool NamesAnalyticModel(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  if (name.size() == text.size()) return false;
  const std::vector<std::string> names = ModelNames();
  if (std::count(names.begin(), names.end(), name) > 0) return true;
  const bool is_word =
      !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
  return is_word && text.find('=') != std::string::npos && text.find('#') == std::string::npos;
}

std::string PlacedParameter::Name() const { return StrCat(parameter->name, Suffix(lobe)); }

std::vector<PlacedParameter> PlacedParameters(const AnalyticModel& model, int lobes) {
  std::vector<PlacedParameter> all;
  std::size_t next = 0;
  const auto place = [&](const ModelParameter& parameter, int lobe) {
    all.push_back({&parameter, lobe, next});
    next += static_cast<std::size_t>(parameter.size);
  };
  for (const ModelParameter& parameter : model.base) place(parameter, 0);
  for (int lobe = 0; lobe < lobes; ++lobe) {
    for (const ModelParameter& parameter : model.lobe) place(parameter, lobe);
  }
  return all;
}

AnalyticBrdf::AnalyticBrdf(const AnalyticModel& model, int lobes, std::vector<double> parameters)
    : model_(&model), lobes_(lobes), parameters_(std::move(parameters)) {
  const int min = model.lobe.empty() ? 0 : 1, max = model.lobe.empty() ? 0 : kMaxLobes;
  if (lobes < min || lobes > max) {
    Fail(model.name, ": ", lobes, " lobes; must be ", min, " to ", max);
  }
  if (parameters_.size() != NumScalars(model, lobes)) {
    Fail(model.name, ": ", parameters_.size(), " parameters, expected ", NumScalars(model, lobes));
  }
  for (const PlacedParameter& placed : PlacedParameters(model, lobes)) {
    const ModelParameter& parameter = *placed.parameter;
    for (int c = 0; c < parameter.size; ++c) {
      const double value = parameters_[placed.first + static_cast<std::size_t>(c)];
      if (!(value >= parameter.lower && value <= parameter.upper)) {
        Fail(model.name, ": ", placed.Name(), " = ", value, "; must be ", parameter.lower, " to ",
             parameter.upper);
      }
    }
  }
}

AnalyticBrdf AnalyticBrdf::FromValues(const std::string& name, const Values& values) {
  const AnalyticModel& model = FindAnalyticModel(name);
  const int lobes = LobesOf(model, values);
  const std::vector<PlacedParameter> all = PlacedParameters(model, lobes);
  std::vector<double> scalars(NumScalars(model, lobes));
  for (const PlacedParameter& placed : all) {
    SetScalars(placed.Name(), {placed.parameter->initial}, placed, &scalars);
  }
  const auto places = PlacesByName(all);
  std::set<std::string> given;
  for (const auto& [key, numbers] : values) {
    const auto found = std::ranges::find(
        places, key, [](const auto& place) -> const auto& { return place.first; });
    if (found == places.end()) {
      std::vector<std::string> known;
      for (const auto& [known_name, placed] : places) known.push_back(known_name);
      Fail(model.name, ": no parameter '", key, "'; did you mean ", Nearest(known, key),
           "? It has ", Join(known, ", "));
    }
    for (const PlacedParameter& placed : found->second) {
      if (!given.insert(placed.Name()).second) {
        Fail(model.name, ": ", placed.Name(), " is given twice");
      }
      SetScalars(StrCat(model.name, ": ", key), numbers, placed, &scalars);
    }
  }
  return AnalyticBrdf(model, lobes, std::move(scalars));
}

AnalyticBrdf AnalyticBrdf::FromText(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) Fail("'", text, "': expected MODEL:NAME=VALUE,...");
  const std::string model = text.substr(0, colon), rest = text.substr(colon + 1);
  Values values;
  for (const std::string& part : rest.empty() ? std::vector<std::string>{} : Split(rest, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) {
      Fail(model, ": '", part, "': expected NAME=VALUE, colours as R/G/B");
    }
    const std::string name(Trim(part.substr(0, equals)));
    std::vector<double> numbers;
    for (const std::string& number : Split(part.substr(equals + 1), '/')) {
      numbers.push_back(ParseNumber(StrCat(model, ": ", name), number));
    }
    if (!values.emplace(name, numbers).second) Fail(model, ": ", name, " is given twice");
  }
  return FromValues(model, values);
}

bool AnalyticBrdf::IsIsotropic() const {
  const std::vector<PlacedParameter> all = PlacedParameters(*model_, lobes_);
  return std::all_of(all.begin(), all.end(), [&](const PlacedParameter& placed) {
    const double value = parameters_[placed.first];
    switch (placed.parameter->when_isotropic) {
      case WhenIsotropic::kAsPrevious:
        return value == parameters_[placed.first - 1];
      case WhenIsotropic::kZero:
        return value == 0.0;
      default:
        return true;
    }
  });
}

std::vector<std::pair<std::string, std::vector<double>>> AnalyticBrdf::NamedValues() const {
  std::vector<std::pair<std::string, std::vector<double>>> named;
  for (const PlacedParameter& placed : PlacedParameters(*model_, lobes_)) {
    const auto first = parameters_.begin() + static_cast<std::ptrdiff_t>(placed.first);
    named.push_back({placed.Name(), std::vector<double>(first, first + placed.parameter->size)});
  }
  return named;
}

std::string AnalyticBrdf::Text() const {
  return TextOf(*model_, NamedValues(), [](double value) { return FormatNumber(value); });
}

std::string AnalyticBrdf::Description() const {
  const auto rounded = [](double value) { return StrCat(value); };
  return StrCat(TextOf(*model_, NamedValues(), rounded), " (", model_->paper, ")");
}

Rgb AnalyticBrdf::Value(const DirectionPair& pair) const {
  return model_->evaluate(ReflectionGeometry(pair), parameters_.data(), lobes_);
}

LambertBrdf::LambertBrdf(const Rgb& rho)
    : AnalyticBrdf(FindAnalyticModel("lambert"), 0, {rho.begin(), rho.end()}) {}

OrenNayarBrdf::OrenNayarBrdf(const Rgb& rho, double sigma)
    : AnalyticBrdf(FindAnalyticModel("oren_nayar"), 0, {rho[0], rho[1], rho[2], sigma}) {}

WardBrdf::WardBrdf(const Rgb& rho_d, const Rgb& rho_s, LobeWidths alpha)
    : AnalyticBrdf(FindAnalyticModel("ward_bounded"), 1,
                   {rho_d[0], rho_d[1], rho_d[2], rho_s[0], rho_s[1], rho_s[2], alpha.x, alpha.y}) {
}

std::string GgxBrdf::Description() const {
  return StrCat("GGX, f0 ", Show(f0_), ", ", alpha_.Description(), ", rho_d ", Show(rho_d_));
}

Rgb GgxBrdf::Value(const DirectionPair& pair) const {
  const double lobe[] = {1.0, 1.0, 1.0, f0_[0], f0_[1], f0_[2], alpha_.x, alpha_.y};
  Rgb value = {};
  GgxFormula::AddLobe(ReflectionGeometry(pair), lobe, value.data());
  const double diffuse = 28.0 / 23.0 * std::numbers::inv_pi * (1.0 - Pow5(1.0 - 0.5 * pair.wi.z)) *
                         (1.0 - Pow5(1.0 - 0.5 * pair.wo.z));
  for (int c = 0; c < 3; ++c) value[c] += rho_d_[c] * (1.0 - f0_[c]) * diffuse;
  return value;
}

}  // namespace pbnbrdf
