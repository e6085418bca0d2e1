// scattered_files.h: files of scattered measurements: those of ALTA [1], and CSV.
//
// An ALTA text file begins with lines "#KEY VALUE": #DIM with the numbers of coordinates and of
// values, #PARAM_IN with the names of the coordinates, one of (L light, V viewer; radians)
//
//   ISOTROPIC_TL_TV_PROJ_DPHI  theta_L, theta_V cos dphi, theta_V sin dphi, dphi from L to V
//   ISOTROPIC_TV_TL_DPHI       theta_V, theta_L, dphi
//   SPHERICAL_TL_PL_TV_PV      theta_L, phi_L, theta_V, phi_V
//   RUSIN_TH_TD_PD             theta_h, theta_d, phi_d
//   RUSIN_TH_PH_TD_PD          theta_h, phi_h, theta_d, phi_d
//   COS_TH                     cos theta_h, at theta_d = 0
//   CARTESIAN                  V and L, as vectors
//
// #PARAM_OUT with the meaning of the values (INV_STERADIAN, RGB_COLOR, or UNKNOWN_OUTPUT if the line
// is missing: f; INV_STERADIAN_COSINE_FACTOR: f cos theta_V), and #VS with the number of columns, 0 to
// 2, that say how sure the first value is, which aren't used. Further lines with # are comments. Then
// follows a row of numbers for each measurement.
//
// The first line of a CSV names its columns, in letters of either case: theta_i, phi_i, theta_o, phi_o in
// radians, or theta_i_deg, ... in degrees, where a negative theta is on the other side of the normal; or wi_x,
// wi_y, wi_z, wo_x, wo_y, wo_z, of any length but 0; and value, or r, g, b: f in 1/sr, without the cosine. Two
// readings of one quantity, such as theta_i and theta_i_deg or value and r, are refused. sigma, or sigma_r,
// sigma_g, sigma_b, is the standard deviation of f and gives the measurements their weights
// (src/sources/sample_weights.h). Other columns are ignored, and so are empty lines and those that begin with
// #, but for one that names the columns. Columns are parted by ';', ',', a tab or blanks. Rows where a number
// is missing (an empty cell, nan, NA, null, none, -) are left out and counted.
//
// An isotropic material needs one phi_i only: where all measurements have the same, or the opposite one (and
// with the coordinates of ALTA that have no phi_h), the material is taken as isotropic, else as anisotropic. A
// line "# isotropic" or "# anisotropic" says otherwise.
//
// [1] L. Belcour, P. Barla, R. Pacanowski. ALTA: A BRDF Analysis Library. Workshop on Material
//     Appearance Modeling, 2014.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Both throw Error, naming the file and the line.
ScatteredBrdf ReadAlta(const std::string& path);
ScatteredBrdf ReadScatteredCsv(const std::string& path);

// Whether a text that begins so is an ALTA file; a CSV: what the first line that isn't a comment says, or a comment
// before it, is about columns of directions, or the text is UTF-16, which ReadScatteredCsv refuses.
bool LooksLikeAlta(std::string_view start);
bool LooksLikeScatteredCsv(std::string_view start);

}  // namespace pbnbrdf
