// nielsen.h: the method of Nielsen et al. (pbnbrdf/sources/table_pca.h) for a material that was measured at a few
// directions, as they published it: the baseline of what knows a database.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// Of the candidates, `count`: directions whose rows of as many components have the least condition number. One after the
// other is added, and in the end each moves to a neighbour, on the list of candidates, while that lowers it.
std::vector<DirectionPair> NielsenDirections(const TablePca& pca,
                                             const std::vector<DirectionPair>& candidates,
                                             int count);

// As many components as there are samples, by ridge regression with their eta, 40. 3 K numbers.
std::vector<double> NielsenCode(const TablePca& pca, std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
