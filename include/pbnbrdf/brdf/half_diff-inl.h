// half_diff-inl.h: half and difference vectors as an expression (operations.h).
//
// This file has no include guard and no namespace: half_diff.h includes it for double, jets and
// printed code, src/network/evaluation.cc once for each instruction set.

// Of the half vector h: (hx, hy, cos_theta), and its angles theta_h and phi_h. Of the difference
// vector, in the frame of h: (dx, dy, dz).
template <class V>
struct HalfDiffOf {
  V hx, hy, cos_theta;
  V sin_theta, cos_phi, sin_phi;
  V dx, dy, dz;
};

// sum = wi + wo, difference = wi - wo. Where the sum is 0, h = +z; where h = +z, phi_h = 0.
template <class V>
HalfDiffOf<V> HalfDiffFromSum(const std::array<V, 3>& sum, const std::array<V, 3>& difference) {
  const auto [length, per_length] = ToRoots(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  const V hx = per_length * sum[0], hy = per_length * sum[1];
  const V hz = IfGreater(per_length, V(0.0), per_length * sum[2], V(1.0));
  const auto [sin_theta, cos_phi, sin_phi] = ToPolar(sum[0], sum[1], per_length);
  // The difference along the tangents of growing theta_h and of growing phi_h.
  const V ex = 0.5 * difference[0], ey = 0.5 * difference[1], ez = 0.5 * difference[2];
  const V dx = ex * (hz * cos_phi) + ey * (hz * sin_phi) - ez * sin_theta;
  const V dy = ey * cos_phi - ex * sin_phi;
  return {hx, hy, hz, sin_theta, cos_phi, sin_phi, dx, dy, 0.5 * length};
}
