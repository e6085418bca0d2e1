// rgl_writer.h: a small file of the RGL kind (rgl.h) for tests.
#pragma once

#include <vector>

#include "sources/tensor_writer.h"
#include "test_util.h"

namespace pbnbrdf {

// A file whose tables don't depend on direction: D = 1 / pi, sigma = 1, all colours `color`. The
// warp is that of a constant density.
inline TensorWriter ConstantFile(std::uint64_t n_phi, const std::vector<float>& color) {
  const std::uint64_t n_theta = 2, size = 3, slices = n_phi * n_theta;
  std::vector<float> phi(n_phi), ones(slices * size * size, 1.0f), colors;
  for (std::uint64_t k = 0; k < n_phi; ++k) {
    phi[k] = n_phi == 1 ? 0.0f : float(-kPi + 2 * kPi * double(k) / double(n_phi - 1));
  }
  for (std::uint64_t s = 0; s < slices; ++s) {
    for (float c : color) colors.insert(colors.end(), size * size, c);
  }
  TensorWriter file;
  file.Add("description", 1, {4}, "test").Add("jacobian", 1, {1}, "\1");
  file.AddFloats("theta_i", {n_theta}, {0.0f, 1.4f}).AddFloats("phi_i", {n_phi}, phi);
  file.AddFloats("ndf", {2, 2}, std::vector<float>(4, float(1 / kPi)));
  file.AddFloats("sigma", {2, 2}, std::vector<float>(4, 1.0f));
  file.AddFloats("vndf", {n_phi, n_theta, size, size}, ones);
  file.AddFloats("luminance", {n_phi, n_theta, size, size}, ones);
  const std::uint64_t channels = color.size();
  if (channels == 3) return file.AddFloats("rgb", {n_phi, n_theta, 3, size, size}, colors);
  std::vector<float> wavelengths(channels);
  for (std::uint64_t k = 0; k < channels; ++k) wavelengths[k] = float(400.0 + 20.0 * double(k));
  return file.AddFloats("wavelengths", {channels}, wavelengths)
      .AddFloats("spectra", {n_phi, n_theta, channels, size, size}, colors);
}

}  // namespace pbnbrdf
