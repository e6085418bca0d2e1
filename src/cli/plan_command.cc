// pbnbrdf plan
#include <iostream>
#include <numbers>
#include <sstream>

#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/database/plan.h"
#include "sources/collection_file.h"

namespace pbnbrdf::cli {
namespace {

struct PlanCommandOptions {
  std::string prior, out = "-";
  MaterialOptions material;
  PlanOptions plan;
};

Fields PlanFields(PlanCommandOptions* options) {
  PlanOptions* plan = &options->plan;
  Fields fields;
  fields.AddRequired(Text("prior", &options->prior,
                          "what a database has in common, a file that pbnbrdf prior wrote"));
  fields.AddCommon(Text("material", &options->material.source,
                        "what was measured of the material already, if anything: a list of "
                        "measurements, see below"));
  fields.AddCommon(Text("out", &options->out, "CSV file for the directions; -: standard output"));
  fields.AddCommon(Integer("count", &plan->count, AtLeast(1), "directions to measure"));
  fields.AddCommon(Number("max_theta", &plan->max_theta, Between(1, 89),
                          "largest angle from the normal that can be measured, degrees"));
  fields.AddCommon(Number("theta_step", &plan->theta_step, Between(1, 89),
                          "step of the angles from the normal, degrees"));
  fields.AddCommon(
      Number("phi_step", &plan->phi_step, Between(1, 180), "step of the azimuth, degrees"));
  return fields;
}

std::string PlanCsv(const std::vector<DirectionPair>& pairs) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::ostringstream csv;
  csv << "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n";
  const auto theta = [](const Vec3& w) { return std::acos(std::min(w.z, 1.0)) / kDegree; };
  for (const auto& [wi, wo] : pairs) {
    const double phi_o = wo.z < 1.0 ? std::atan2(wo.y, wo.x) / kDegree : 0.0;
    csv << theta(wi) << ",0," << theta(wo) << "," << phi_o << "\n";
  }
  return csv.str();
}

int RunPlan(const PlanCommandOptions& options, const Arguments&) {
  CheckOutputs({{"out", options.out}});
  const auto prior = ReadCollection(options.prior);
  std::vector<BrdfSample> measured;
  if (!options.material.source.empty()) {
    measured = options.material.Open()->Measurements();
    if (measured.empty()) Fail(options.material.source, ": isn't a list of measurements");
  }
  const std::vector<DirectionPair> pairs = std::visit(
      [&](const auto& known) { return PlanDirections(known, measured, options.plan); }, *prior);
  WriteFile(options.out, PlanCsv(pairs));
  return 0;
}

}  // namespace

Command PlanCommand() {
  return Command{.name = "plan",
                 .summary = "says which directions to measure, given a database",
                 .usage = R"(  pbnbrdf plan --prior=merl.pca --count=8
  pbnbrdf plan --prior=merl.pca --count=8 --material=measured.csv --out=next.csv
)",
                 .notes = StrCat(kSourceNotes, R"(
Prints pairs of directions, the one that tells most first. With columns r,g,b of measured values
the file is a material that pbnbrdf fit --prior takes.
)")}
      .With(PlanFields, RunPlan);
}

}  // namespace pbnbrdf::cli
