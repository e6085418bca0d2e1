// operations.h: the operations that functions of a direction pair are written in, beside + - * /.
//
// A function template of V in a file *-inl.h is an expression that is written once and computed on any
// V that has these operations: on double and on ceres::Jet by what stands here, on vectors of floats by
// network/float_vector-inl.h, and on lines of C, GLSL, Python and ONNX by export/term.h.
#pragma once

#include <cmath>

namespace pbnbrdf {

using std::expm1, std::floor, std::log, std::sqrt, std::tanh;

// `yes` where a > b, else `no`, also where a or b is not a number.
template <class V>
V IfGreater(const V& a, const V& b, const V& yes, const V& no) {
  return a > b ? yes : no;
}

template <class V>
V Max(const V& a, const V& b) {
  return IfGreater(a, b, a, b);
}

template <class V>
V Min(const V& a, const V& b) {
  return IfGreater(a, b, b, a);
}

// sqrt(x) and 1 / sqrt(x), which is 0 at 0.
template <class V>
struct Roots {
  V root, inverse;
};

template <class V>
Roots<V> ToRoots(const V& x) {
  const V root = sqrt(x);
  return {root, IfGreater(root, V(0.0), 1.0 / root, V(0.0))};
}

// The vector (scale x, scale y), scale >= 0, as its length and its direction, which is (1, 0) where the
// length is 0.
template <class V>
struct Polar {
  V length, cos_phi, sin_phi;
};

template <class V>
Polar<V> ToPolar(const V& x, const V& y, const V& scale) {
  using std::hypot;
  const V scaled_x = scale * x, scaled_y = scale * y, zero(0.0);
  const V length = hypot(scaled_x, scaled_y);
  return {length, IfGreater(length, zero, scaled_x / length, V(1.0)),
          IfGreater(length, zero, scaled_y / length, zero)};
}

// The angle in [0, pi] of a sine >= 0 and its cosine.
template <class V>
V AngleOf(const V& sine, const V& cosine) {
  using std::atan2;
  return atan2(sine, cosine);
}

}  // namespace pbnbrdf
