// minimax.h: coefficients of elementary functions in single precision, fitted for the least maximal
// error; the lowest power comes first. Vectors of float and exported shaders use the same ones.
#pragma once

namespace pbnbrdf::kernels {

// expm1(r) = r + r^2 P(r) for |r| <= log(2) / 2.
inline constexpr float kExpm1Polynomial[] = {0.499999982f, 0.166665437f, 0.0416671996f,
                                             0.00836651394f, 0.00138825227f};

// 2 atan(t) = t P(t^2) for 0 <= t <= 1.
inline constexpr float kTwoAtanPolynomial[] = {1.999999972f,  -0.66666188f,   0.399861058f,
                                               -0.284142672f, 0.213093548f,   -0.150673521f,
                                               0.0860787358f, -0.0325660162f, 0.0058071051f};

// log 2 = kLog2High + kLog2Low. The first has so few bits that its products with small integers are
// exact.
inline constexpr float kLog2High = 0.693359375f, kLog2Low = -2.12194440e-4f;
inline constexpr float kPerLog2 = 1.44269504f;

}  // namespace pbnbrdf::kernels
