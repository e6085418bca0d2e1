#include "fit_material.h"

#include "base/about.h"
#include "pbnbrdf/database/start_from_prior.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/collection_file.h"

namespace pbnbrdf::cli {
namespace {

constexpr double kMinPart = 0.8;  // of --max_seconds, for the fit itself

// When all should be done: half of what a fit may run over, which is half a second or a tenth.
double End(double max_seconds) { return max_seconds + std::max(0.25, 0.05 * max_seconds); }

// Of the network in a file, which must have the shape and the encoding that the problem has.
std::vector<double> WeightsOf(const std::string& path, const NetworkShape& shape) {
  const NeuralBrdf network = OpenNetwork(path);
  const auto describe = [](const NetworkShape& s) {
    return StrCat(s.Description(), ", ", NameOf(kEncodings, s.encoding()), " encoding");
  };
  const std::string found = describe(network.shape()), wanted = describe(shape);
  if (found != wanted) Fail(path, ": a network ", found, "; --init needs ", wanted);
  return network.weights();
}

}  // namespace

Fields SubjectFields(FitRequest* request) {
  Fields fields;
  fields.Group("The material and the files");
  fields.AddRequired(MaterialField(&request->material));
  fields.Add(ScaleField(&request->material));
  fields.Add(Text("init", &request->init,
                  "start from this fitted network, which has the same shape and encoding"));
  fields.Add(Text("prior", &request->prior,
                  "what a database has in common, by pbnbrdf prior: start from what it says of the "
                  "material, which decides where nothing was measured"));
  return fields;
}

MaterialFitter::MaterialFitter(const FitRequest& request)
    : request_(request),
      material_(request.material.Open()),
      problem_(request.setup.problem),
      options_(request.setup.options) {
  if (!request.prior.empty()) {
    const auto prior = ReadCollection(request.prior);
    About(request.material.source, [&] {
      std::visit(
          [&](const auto& known) { StartFromPrior(known, *material_, &problem_, &options_); },
          *prior);
    });
  }
  if (!request.init.empty()) {
    options_.initial_weights = WeightsOf(request.init, problem_.For(*material_).Shape());
  }
}

FittedMaterial MaterialFitter::Run(
    bool reports_heldout_error, const std::function<bool(const FitProgress&)>& on_iteration) const {
  const double checks = SecondsOfChecks(problem_.For(*material_).Shape());
  FitOptions options = options_;
  const double max_seconds = options.schedule.max_seconds, end = End(max_seconds) - checks;
  options.schedule.max_seconds = std::max(end - timer_.Seconds(), kMinPart * max_seconds);
  options.limits_wall_time = true;
  options.reports_heldout_error = reports_heldout_error;
  options.on_iteration = on_iteration;
  Fit fit = About(request_.material.source, [&] { return FitBrdf(*material_, problem_, options); });
  Json measures =
      MeasureFit(*material_, fit.network, fit.network.weights().size(),
                 {.seconds = end - timer_.Seconds(), .profile = fit.summary.energy.profile});
  FitRequest copy = request_;
  FitSubject subject = {request_.material, SubjectFields(&copy).Lines() +
                                               ProblemText({fit.problem, request_.setup.options})};
  return {std::move(fit), std::move(measures), std::move(subject)};
}

}  // namespace pbnbrdf::cli
