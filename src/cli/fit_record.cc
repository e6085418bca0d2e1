#include "fit_record.h"

#include <gflags/gflags.h>

#include <nlohmann/json.hpp>

#include "base/text.h"

DECLARE_string(terms);

namespace pbnbrdf::cli {
namespace {

nlohmann::ordered_json EnergyJson(const EnergySummary& energy) {
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

}  // namespace

NeuralBrdf::Metadata FitMetadata(const FitSubject& subject, const FitProblem& problem,
                                 const FitSummary& summary,
                                 const nlohmann::ordered_json& measures) {
  return {{"version", PBNBRDF_VERSION},
          {"material", subject.material},
          {"scale_to_albedo", FormatNumber(subject.scale_to_albedo)},
          {"terms", FLAGS_terms},
          {"problem", subject.problem},
          {"seed", StrCat(problem.seed)},
          {"termination", std::string(NameOf(kTerminations, summary.termination))},
          {"mean_abs_log_error", FormatNumber(measures["mean_abs_log_error"])},
          {"max_directional_albedo", FormatNumber(measures["max_directional_albedo"])}};
}

nlohmann::ordered_json FitSummaryJson(const FitSubject& subject, const FitProblem& problem,
                                      const FitSummary& summary, nlohmann::ordered_json measures) {
  measures["material"] = subject.material;
  measures["scale_to_albedo"] = subject.scale_to_albedo;
  measures["cost"] = summary.final_cost;
  measures["iterations"] = summary.iterations;
  measures["restarts"] = summary.restarts;
  measures["failed_factorizations"] = summary.failed_factorizations;
  measures["rejected_steps"] = summary.rejected_steps;
  measures["samples_used"] = summary.samples;
  measures["energy_term"] = EnergyJson(summary.energy);
  measures["precision_limited"] = summary.precision_limited;
  measures["seconds"] = summary.seconds;
  measures["seed"] = problem.seed;
  measures["termination"] = NameOf(kTerminations, summary.termination);
  measures["message"] = summary.message;
  measures["version"] = PBNBRDF_VERSION;
  measures["problem"] = subject.problem;
  return measures;
}

std::string JsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace pbnbrdf::cli
