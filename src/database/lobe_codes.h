// lobe_codes.h: materials of an analytic model, as far as the components of a database can express them.
#pragma once

#include <Eigen/Core>

#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// n = 0, 1, ...: a lobe of GGX, one of three, or of Cook and Torrance, above a Lambertian ground. Any first few are all
// over the parameters, evenly in their logarithms.
AnalyticBrdf Lobe(int n);

// A column for each of 400 of these: the code nearest to it in mapped values (table_pca.h). K x 400.
Eigen::MatrixXd LobeCodes(const TablePca& pca);

}  // namespace pbnbrdf
