// material_options.h: the flags that say what the material is.
#pragma once

#include <memory>
#include <string>

#include "base/fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf::cli {

struct MaterialOptions {
  std::string source;
  double scale_to_albedo = 0.0;  // 0: not scaled
  bool symmetrize = false;       // to average both orders of each pair (brdf/reciprocal.h)

  // Throws Error.
  std::unique_ptr<Brdf> Open() const;
};

Field MaterialField(MaterialOptions* material);
Field ScaleField(MaterialOptions* material);
Field SymmetrizeField(bool* symmetrize);

// How every command that reads a material explains --material.
inline constexpr char kSourceNotes[] =
    R"(Sources of reflectance; the format of a file is told by its content, not its name:
  FILE.binary                  a table in the format of the MERL BRDF database
  FILE.bsdf                    a measurement of the RGL material database, RGB or spectral, or a
                               tabular BRDF of Zemax
  FILE.alta, FILE.dat          measurements in the text format of ALTA
  FILE.brdf                    spectral measurements of Cornell's goniometer
  FILE.astm                    measurements in the format of ASTM E1392
  FILE.txt                     measurements in the text format of FRED, or in one plane: columns
                               phi_in theta_in phi_out theta_out brdf
  FILE.csv                     measurements at any directions: columns theta_i,phi_i,theta_o,phi_o
                               (radians; theta_i_deg, ...: degrees) or wi_x,wi_y,wi_z,wo_x,..., and
                               value or r,g,b: f in 1/sr; sigma, its standard deviation, may follow.
                               The material is taken for anisotropic if phi_i varies by anything but
                               180 degrees, unless a line '# isotropic' or '# anisotropic' says what
                               it is
  sgd:PARAMETERS.csv#MATERIAL  the shifted gamma distribution model (Bagher et al. 2012)
  builtin:NAME                 a material that comes with the program; pbnbrdf info builtin: lists
                               them
  MODEL:NAME=VALUE,...         an analytic model with its parameters, such as
                               ggx:f0=1/0.78/0.34,alpha=0.2; pbnbrdf info models: lists them
  FILE.json                    an analytic model that pbnbrdf fit-model wrote
  FILE.safetensors             a network that pbnbrdf fit wrote
  FILE.h5, FILE.keras          a network of NBRDF (Sztrajman et al. 2021), weights or a whole model
                               that Keras saved
  BASEfc1.npy                  the same as NumPy files: BASE and fc1, fc2, fc3, b1, b2 or b3, and
                               .npy
  FILE#MATERIAL                a material of a file that holds several, by pbnbrdf prior
)";

}  // namespace pbnbrdf::cli
