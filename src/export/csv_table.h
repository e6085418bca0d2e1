// csv_table.h: values of a Brdf at a grid of angles, as text.
#pragma once

#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// A CSV with the columns theta_i,phi_i,theta_o,phi_o (radians) and r,g,b (linear, 1/sr, without the
// cosine), one header line. The grid is one of Rusinkiewicz angles:
//
//   theta_h = (pi/2) (i/45)^2, i = 0..44     dense near the mirror direction
//   theta_d = i 5 degrees, i = 0..17
//   phi_d   = i 15 degrees, i = 0..23
//   phi_h   = 0 if the Brdf is isotropic, else i 30 degrees, i = 0..11
//
// of which the pairs above the horizon are written, each once. Values are those at the angles as
// they are written. Isotropic: phi_i = 0.
std::string CsvTable(const Brdf& brdf);

}  // namespace pbnbrdf
