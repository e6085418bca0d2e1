// cie.h: what spectra of reflectance look like: linear sRGB by the CIE 1931 standard observer [1]
// under the illuminant D65 [2].
//
// Each channel is divided by what a perfect diffuser gives in it over the same wavelengths: a
// reflectance that is constant over wavelength has r = g = b equal to that constant, whatever part
// of the visible range was measured.
//
// [1] C. Wyman, P.-P. Sloan, P. Shirley. Simple Analytic Approximations to the CIE XYZ Color Matching
//     Functions. JCGT 2(2), 2013: the fits of several lobes.
// [2] CIE 15:2004, Colorimetry: table T.1, relative spectral power, every 10 nm.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline constexpr float kLongestWavelength = 1e5f;  // nm, of what is taken for one

// The colour matching functions x, y, z at a wavelength, nm.
std::array<double, 3> ColorMatching(double wavelength);

// Relative power of D65, 100 at 560 nm; linear between 10 nm steps from 380 to 780 nm, 0 elsewhere.
double IlluminantD65(double wavelength);

// Linear sRGB of a reflectance known at the wavelengths (nm, ascending) and linear in between:
// rgb[c] = sum over k of weights[k][c] times its value at wavelength k. The weights of a channel sum
// to 1; some are negative. A single wavelength: r = g = b. Throws Error if the wavelengths cover less
// than 430 to 660 nm, the part without which a channel would be little more than a guess, or reach beyond kLongestWavelength.
std::vector<Rgb> SpectrumToRgb(std::span<const float> wavelengths);

// The same; its Error names the file.
std::vector<Rgb> SpectrumToRgb(const std::string& path, std::span<const float> wavelengths);

// Such weights of X, Y, Z, which are (0.9505, 1, 1.089) where r = g = b = 1 (IEC 61966-2-1).
std::vector<Rgb> XyzToRgb();

// The sum of weights[k] times values[k]; of the same size.
Rgb WeightedSum(std::span<const Rgb> weights, std::span<const double> values);

}  // namespace pbnbrdf
