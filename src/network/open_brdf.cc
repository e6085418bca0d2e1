#include "pbnbrdf/network/open_brdf.h"

#include "pbnbrdf/brdf/open_brdf.h"
#include "pbnbrdf/network/nbrdf_files.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

std::unique_ptr<Brdf> OpenBrdf(const std::string& source) {
  if (source.ends_with(".safetensors") || IsNbrdfFile(source)) {
    return std::make_unique<NeuralBrdf>(NeuralBrdf::Read(source));
  }
  return OpenMeasuredBrdf(source);
}

}  // namespace pbnbrdf
