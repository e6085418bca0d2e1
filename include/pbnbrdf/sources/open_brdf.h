// open_brdf.h: a source of reflectance from the text that names it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// "sgd:PARAMETERS.csv#MATERIAL" (models/sgd.h), "builtin:NAME" (models/builtin.h), an analytic model with
// its parameters, "MODEL:NAME=VALUE,..." (models/analytic.h), or a file: of an analytic model, of the formats in
// rgl.h, merl.h, scattered_files.h (ALTA, CSV), zemax.h, fred.h, astm.h, cornell.h or in_plane.h, or what OpenNetwork
// opens. Files are told by what they hold, whatever their names. One that none of the formats recognises, as a
// damaged one, is read as what its name's ending says. Throws Error, which says that no format recognises it if the
// name says nothing either.
std::unique_ptr<Brdf> OpenBrdf(const std::string& source);

// A fitted network, or one that Sztrajman et al. published: "FILE.h5", "BASEfc1.npy" (nbrdf_files.h). Throws Error.
NeuralBrdf OpenNetwork(const std::string& path);

}  // namespace pbnbrdf
