#include "opened_fit.h"

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {

OpenedFit OpenFit(const std::string& source) {
  std::unique_ptr<Brdf> brdf = OpenBrdf(source);
  std::size_t parameters = 0;
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(brdf.get())) {
    parameters = network->weights().size();
  } else if (const auto* model = dynamic_cast<const AnalyticBrdf*>(brdf.get())) {
    parameters = model->parameters().size();
  } else {
    Fail(source, ": neither a fitted network nor an analytic model");
  }
  return {std::move(brdf), parameters};
}

Field FitField(std::string* source) {
  return Text("fit", source,
              "fitted network (.safetensors, or NBRDF's .h5 or fc1.npy) or analytic model (.json)");
}

}  // namespace pbnbrdf::cli
