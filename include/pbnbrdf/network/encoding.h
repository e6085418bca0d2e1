// encoding.h: a direction pair as the input of a network, by one of the encodings of
// expressions-inl.h.
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/merl_rows.h"

namespace pbnbrdf {

inline constexpr int kEncodedSize = 6;

#include "pbnbrdf/network/expressions-inl.h"

enum class Encoding {
#define PBNBRDF_ENUMERATOR(enumerator, ...) enumerator,
  PBNBRDF_ENCODINGS(PBNBRDF_ENUMERATOR)
#undef PBNBRDF_ENUMERATOR
};

inline constexpr auto kEncodings = std::to_array<std::pair<std::string_view, Encoding>>({
#define PBNBRDF_NAME(enumerator, name, ...) {name, Encoding::enumerator},
    PBNBRDF_ENCODINGS(PBNBRDF_NAME)
#undef PBNBRDF_NAME
});

// Materials by what they ask of an encoding.
enum class MaterialKind {
  kTable,  // isotropic, with values at the rows of a MERL table; a formula is fitted as if it had them
  kScattered,  // isotropic, measured at directions of its own: the merl encoding may ripple between rows
  kAnisotropic,
};

struct EncodingTraits {
  bool isotropic = false;
  bool reciprocal = false;
  std::optional<MaterialKind> default_of = {};  // the materials that get it if none is asked for
};

constexpr EncodingTraits TraitsOf(Encoding encoding) {
  constexpr EncodingTraits kTraits[] = {
#define PBNBRDF_TRAITS(enumerator, name, expression, ...) {__VA_ARGS__},
      PBNBRDF_ENCODINGS(PBNBRDF_TRAITS)
#undef PBNBRDF_TRAITS
  };
  return kTraits[static_cast<std::size_t>(encoding)];
}

// Whether networks with this encoding are isotropic, whatever their weights.
constexpr bool IsIsotropic(Encoding encoding) { return TraitsOf(encoding).isotropic; }

// Whether the inputs, and with them the values of any network, have the same bits when wi and wo are
// exchanged.
constexpr bool IsReciprocal(Encoding encoding) { return TraitsOf(encoding).reciprocal; }

// The default for a kind of material; there is one for each.
constexpr Encoding DefaultEncoding(MaterialKind kind) {
  return std::find_if(
             kEncodings.begin(), kEncodings.end() - 1,
             [kind](const auto& named) { return TraitsOf(named.second).default_of == kind; })
      ->second;
}

inline Encoding EncodingFor(const Brdf& material) {
  if (!material.IsIsotropic()) return DefaultEncoding(MaterialKind::kAnisotropic);
  return DefaultEncoding(material.HasOwnDirections() ? MaterialKind::kScattered
                                                     : MaterialKind::kTable);
}

// On any V of brdf/operations.h.
template <class V>
Inputs<V> Encode(Encoding encoding, const HalfDiffOf<V>& v) {
  switch (encoding) {
#define PBNBRDF_CASE(enumerator, name, expression, ...) \
  case Encoding::enumerator:                            \
    return expression(v);
    PBNBRDF_ENCODINGS(PBNBRDF_CASE)
#undef PBNBRDF_CASE
  }
  Fail("encoding ", static_cast<int>(encoding), " is not in the table");
}

inline Inputs<double> Encode(Encoding encoding, const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  return Encode(encoding, HalfDiffFromPair<double>({wi.x, wi.y, wi.z}, {wo.x, wo.y, wo.z}));
}

}  // namespace pbnbrdf
