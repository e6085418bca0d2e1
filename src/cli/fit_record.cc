#include "fit_record.h"

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "problem/problem_fields.h"

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

std::string TermsText(TermOptions terms) { return TermFields(&terms).Find("terms")->text(); }

}  // namespace

NeuralBrdf WithMetadata(const Fit& fit, const FitSubject& subject,
                        const nlohmann::ordered_json& measures) {
  const auto& [network, problem, summary] = fit;
  return {network.shape(),
          network.weights(),
          {{"version", PBNBRDF_VERSION},
           {"material", subject.material.source},
           {"scale_to_albedo", FormatNumber(subject.material.scale_to_albedo)},
           {"terms", TermsText(problem.terms)},
           {"problem", subject.flagfile},
           {"seed", StrCat(problem.sampling.seed)},
           {"termination", std::string(NameOf(kTerminations, summary.termination))},
           {"mean_abs_log_error", FormatNumber(measures["mean_abs_log_error"])},
           {"max_directional_albedo", FormatNumber(measures["max_directional_albedo"])}}};
}

nlohmann::ordered_json FitSummaryJson(const Fit& fit, const FitSubject& subject,
                                      nlohmann::ordered_json measures) {
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
  measures["version"] = PBNBRDF_VERSION;
  measures["problem"] = subject.flagfile;
  return measures;
}

}  // namespace pbnbrdf::cli
