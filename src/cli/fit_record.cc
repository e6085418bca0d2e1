#include "fit_record.h"

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "problem/problem_fields.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kMaxMoments = 400;  // of a fit's history in the summary

Json EnergyJson(const EnergySummary& energy) {
  return {{"first_max_albedo", energy.first_max_albedo},
          {"max_albedo", energy.max_albedo},
          {"rounds", energy.rounds},
          {"strata", energy.strata},
          {"correction", energy.correction},
          {"albedos", energy.work.albedos},
          {"albedos_skipped", energy.work.albedos_skipped},
          {"jacobians", energy.work.jacobians},
          {"jacobians_skipped", energy.work.jacobians_skipped}};
}

// Of at most kMaxMoments of the moments: [iteration, seconds, error] each.
Json HistoryJson(const std::vector<FitMoment>& history) {
  Json json = Json::array();
  const std::size_t stride = history.size() / kMaxMoments + 1;
  for (std::size_t n = 0; n < history.size(); n += stride) {
    json.push_back({history[n].iteration, history[n].seconds, history[n].error});
  }
  return json;
}

std::string TermsText(TermOptions terms) { return TermFields(&terms).Find("terms")->text(); }

}  // namespace

NeuralBrdf WithMetadata(const Fit& fit, const FitSubject& subject, const Json& measures) {
  const auto& [network, problem, summary] = fit;
  std::map<std::string, std::string> metadata = {
      {"version", PBNBRDF_VERSION},
      {"material", subject.material.source},
      {"scale_to_albedo", FormatNumber(subject.material.scale_to_albedo)},
      {"terms", TermsText(problem.terms)},
      {"problem", subject.flagfile},
      {"seed", StrCat(problem.sampling.seed)},
      {"termination", std::string(NameOf(kTerminations, summary.termination))},
      {"mean_abs_log_error", FormatNumber(measures["mean_abs_log_error"])},
      {"max_directional_albedo", FormatNumber(measures["max_directional_albedo"])}};
  if (!subject.fingerprint.empty()) metadata["fingerprint"] = subject.fingerprint;
  return {network.shape(), network.weights(), std::move(metadata)};
}

Json FitSummaryJson(const Fit& fit, const FitSubject& subject, Json measures) {
  const FitSummary& summary = fit.summary;
  measures["material"] = subject.material.source;
  measures["scale_to_albedo"] = subject.material.scale_to_albedo;
  measures["cost"] = summary.final_cost;
  measures["iterations"] = summary.iterations;
  measures["restarts"] = summary.restarts;
  measures["failed_factorizations"] = summary.failed_factorizations;
  measures["rejected_steps"] = summary.rejected_steps;
  measures["samples_used"] = summary.samples;
  measures["energy_term"] = EnergyJson(summary.energy);
  measures["precision_limited"] = summary.precision_limited;
  measures["seconds"] = summary.seconds;
  measures["seed"] = fit.problem.sampling.seed;
  measures["termination"] = NameOf(kTerminations, summary.termination);
  measures["message"] = summary.message;
  measures["history"] = HistoryJson(summary.history);
  measures["version"] = PBNBRDF_VERSION;
  measures["problem"] = subject.flagfile;
  return measures;
}

}  // namespace pbnbrdf::cli
