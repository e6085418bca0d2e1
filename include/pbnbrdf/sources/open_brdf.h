// open_brdf.h: a source of reflectance from the text that names it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// "sgd:PARAMETERS.csv#MATERIAL" (models/sgd.h), "builtin:NAME" (models/builtin.h), an analytic model with
// its parameters, "MODEL:NAME=VALUE,..." (models/analytic.h), "FILE#MATERIAL" of a file that holds several
// (network/weight_family.h, table_pca.h), or a file in any format that a header of this folder reads. The format
// of a file is told by its content, not its name. Where no format recognises the content, as of a damaged file, the
// name's ending decides. Throws Error, which says that no format recognises the file if the name says nothing
// either.
std::unique_ptr<Brdf> OpenBrdf(const std::string& source);

// A fitted network, one of a database, "FILE.prior#MATERIAL", or one that Sztrajman et al. published: "FILE.h5",
// "BASEfc1.npy" (nbrdf_files.h). Throws Error.
NeuralBrdf OpenNetwork(const std::string& path);

}  // namespace pbnbrdf
