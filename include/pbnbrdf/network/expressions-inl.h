// expressions-inl.h: the encodings and the output unit of networks as expressions (brdf/operations.h),
// and a table of all encodings.
//
// This file has no include guard and no namespace: encoding.h includes it for double, jets and printed
// code, src/network/evaluation.cc once for each instruction set.
//
// An encoding turns h and d (half_diff-inl.h) into the inputs of a network. Below, th = theta_h and
// s = sin theta_d = sqrt(dx^2 + dy^2).

template <class V>
using Inputs = std::array<V, kEncodedSize>;

// The vector (x, y), squared as a complex number: the angle is doubled, and (-x, -y) gives the same
// bits. Of d this is s^2 (cos 2 phi_d, sin 2 phi_d).
template <class V>
std::array<V, 2> DoubleAngle(const V& x, const V& y) {
  return {x * x - y * y, 2.0 * x * y};
}

// th on two scales, which resolve lobes of any width: sqrt(2 th / pi) and log(th + 0.001) / 3.
template <class V>
std::array<V, 2> ScaleTheta(const HalfDiffOf<V>& v) {
  const V theta = AngleOf(v.sin_theta, v.cos_theta);
  return {sqrt(theta * 2.0 / std::numbers::pi), log(theta + 1e-3) / 3.0};
}

// (cos theta_i + cos theta_o) / 2 and (cos theta_o - cos theta_i) / 2.
template <class V>
std::array<V, 2> Elevations(const HalfDiffOf<V>& v) {
  return {v.cos_theta * v.dz, v.sin_theta * v.dx};
}

// (hx, hy, hz, dx, dy, dz) with h turned to phi_h = 0, NBRDF's. hy = 0 always.
template <class V>
Inputs<V> CartesianInputs(const HalfDiffOf<V>& v) {
  return {v.sin_theta, V(0.0), v.cos_theta, v.dx, v.dy, v.dz};
}

// (hx, hy, hz, (dx^2 - dy^2) / s, 2 dx dy / s, dz): phi_d doubled, section 4.1 of the paper.
template <class V>
Inputs<V> ReciprocalInputs(const HalfDiffOf<V>& v) {
  const auto [x, y] = DoubleAngle(v.dx, v.dy);
  const V per_s = ToRoots(v.dx * v.dx + v.dy * v.dy).inverse;
  return {v.sin_theta, V(0.0), v.cos_theta, x * per_s, y * per_s, v.dz};
}

// (sin th, sqrt(2 th / pi), log(th + 0.001) / 3, dx^2 - dy^2, 2 dx dy, dz): smooth where s = 0.
template <class V>
Inputs<V> MultiscaleInputs(const HalfDiffOf<V>& v) {
  const auto [x, y] = DoubleAngle(v.dx, v.dy);
  const auto [root, log_theta] = ScaleTheta(v);
  return {v.sin_theta, root, log_theta, x, y, v.dz};
}

// (cos theta_i cos theta_o, sqrt(2 th / pi), log(th + 0.001) / 3, dx^2 - dy^2,
// (cos theta_i + cos theta_o) / 2, dz). Both elevations are known, in no order: what depends on them, such
// as the shadows at grazing angles, need not be put together from the others. phi_d and -phi_d are one.
template <class V>
Inputs<V> ElevationsInputs(const HalfDiffOf<V>& v) {
  const V x = v.dx * v.dx - v.dy * v.dy;
  const auto [root, log_theta] = ScaleTheta(v);
  const auto [mean, half_difference] = Elevations(v);
  return {mean * mean - half_difference * half_difference, root, log_theta, x, mean, v.dz};
}

// As multiscale, with 4 u (1 - u) for sin th. u in [0, 1) is where th lies between two of the 90 rows
// of a MERL table, whose theta_h grows as the square of the row's number: 0 at a row, 1 midway. A table
// that is interpolated linearly has a kink at each row, and across a sharp highlight f changes tenfold
// from one row to the next: most of the error of a smooth network is there, between the rows.
template <class V>
Inputs<V> MerlInputs(const HalfDiffOf<V>& v) {
  const auto [x, y] = DoubleAngle(v.dx, v.dy);
  const auto [root, log_theta] = ScaleTheta(v);
  constexpr double kRows = kMerlRows;
  const V row = kRows * root, u = row - floor(row);
  return {4.0 * u * (1.0 - u), root, log_theta, x, y, v.dz};
}

// (r cos phi_h, r sin phi_h, log(th + 0.001) / 3, tx^2 - ty^2, 2 tx ty, dz), for anisotropic
// materials: r = (2 th / pi)^(3/4), (tx, ty) = (dx, dy) turned by phi_h. The frame of d spins with
// phi_h, that of t doesn't: all inputs are continuous at h = +z, which lowers the error of a brushed
// metal fivefold. Powers of th from 1/2 to 1 differ by less than seeds do.
template <class V>
Inputs<V> AnisotropicInputs(const HalfDiffOf<V>& v) {
  const auto [root, log_theta] = ScaleTheta(v);
  const auto [x, y] =
      DoubleAngle(v.dx * v.cos_phi - v.dy * v.sin_phi, v.dx * v.sin_phi + v.dy * v.cos_phi);
  const V r = root * sqrt(root);
  return {r * v.cos_phi, r * v.sin_phi, log_theta, x, y, v.dz};
}

// As elevations, but with cos theta_i and cos theta_o themselves, in this order: for measurements whose
// f(wi, wo) and f(wo, wi) contradict each other, and that are to be followed all the same.
template <class V>
Inputs<V> NonreciprocalInputs(const HalfDiffOf<V>& v) {
  const V x = v.dx * v.dx - v.dy * v.dy;
  const auto [root, log_theta] = ScaleTheta(v);
  const auto [mean, half_difference] = Elevations(v);
  return {mean - half_difference, root, log_theta, x, mean + half_difference, v.dz};
}

// The output unit where a network is evaluated: expm1(z), clamped to [0, Brdf::kLargestValue]; 0 where
// z is not a number. expm1(30) = 1.07e13 is above the limit, and single precision still holds it.
template <class V>
V ClampedReflectance(const V& z) {
  const V positive = IfGreater(z, V(0.0), z, V(0.0));
  return Min(expm1(Min(positive, V(30.0))), V(Brdf::kLargestValue));
}

// All encodings: enumerator, name, expression, and of EncodingTraits those that are true. Everything
// else comes from here: the enumeration, parser and help, scalar and vector code, the exported
// programs, and the tests of what holds for every encoding.
#ifndef PBNBRDF_ENCODINGS
// clang-format off
#define PBNBRDF_ENCODINGS(ENCODING)                                                            \
  ENCODING(kCartesian, "cartesian", CartesianInputs, .isotropic = true)                        \
  ENCODING(kReciprocal, "reciprocal", ReciprocalInputs, .isotropic = true, .reciprocal = true) \
  ENCODING(kMultiscale, "multiscale", MultiscaleInputs, .isotropic = true, .reciprocal = true) \
  ENCODING(kElevations, "elevations", ElevationsInputs, .isotropic = true, .reciprocal = true, \
           .default_of = MaterialKind::kScattered)                                             \
  ENCODING(kMerl, "merl", MerlInputs, .isotropic = true, .reciprocal = true,                   \
           .default_of = MaterialKind::kTable)                                                 \
  ENCODING(kAnisotropic, "anisotropic", AnisotropicInputs, .reciprocal = true,                 \
           .default_of = MaterialKind::kAnisotropic)                                            \
  ENCODING(kNonreciprocal, "nonreciprocal", NonreciprocalInputs, .isotropic = true)
// clang-format on
#endif
