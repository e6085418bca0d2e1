#include "pbnbrdf/database/train_family.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "base/timer.h"
#include "database/code_minimizer.h"
#include "database/family_objective.h"
#include "database/family_step.h"
#include "pbnbrdf/base/error.h"
#include "problem/initial_weights.h"
#include "solve/energy_constraints.h"
#include "solve/energy_correction.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::uint64_t kSamplesOfEach = 3000;  // of each material, by default
constexpr double kLossScale = 0.01;
// J'J is summed over so many of them: of all materials together that is plenty for each weight.
constexpr std::size_t kCurvatureSamples = 1500;
constexpr std::size_t kCommonPairs = 3000;  // at which the codes' principal components are taken
constexpr std::uint64_t kCommonSeed = 77;
constexpr std::size_t kStartSamples = 10;  // of each material, for the first weights
constexpr int kMeanIterations = 40;        // for the mean alone, before there are codes

constexpr double kRidge = 1e-6;  // of the squared codes, in a material's cost
constexpr double kFirstRadius = 100.0, kMaxRadius = 1e7, kMinQuality = 1e-3;
constexpr int kMaxTries = 8;
// Training ends where so many iterations lower the cost by less than this part.
constexpr int kWindow = 25;
constexpr double kLeastDecrease = 0.02;

// The weight of a member's energy term grows so far; then its target falls, by what albedos are above it.
constexpr int kEnergyRounds = 20;
constexpr double kClearlyConserved = 0.99, kFirstEnergyWeight = 1.0, kEnergyWeightGrowth = 10.0,
                 kLargestEnergyWeight = 1e4;

// The unknowns, and the steps that improve them.
class Trainer {
 public:
  Trainer(FamilyObjective* objective, FamilyPoint first, const FamilyOptions& options,
          const Timer& timer)
      : objective_(objective), options_(options), timer_(timer), point_(std::move(first)) {
    parts_ = std::max<std::size_t>(1, objective->of(0).num_samples() / kCurvatureSamples);
    Linearize();
    cost_ = objective_->Cost(point_);
  }

  // Until nothing is to be gained any more, the user stops it or the time is up.
  void Run(int max_iterations) {
    std::vector<double> costs = {cost_};
    for (int k = 0; k < max_iterations && timer_.Seconds() < options_.max_seconds; ++k) {
      if (!TakeStep()) return;
      ++iterations_;
      costs.push_back(cost_);
      if (options_.on_iteration &&
          !options_.on_iteration({iterations_, MeanCost(), timer_.Seconds()})) {
        return;
      }
      if (k >= kWindow && costs[k - kWindow] - cost_ < kLeastDecrease * cost_) return;
      Linearize();
    }
  }

  FamilyPoint& point() { return point_; }
  int iterations() const { return iterations_; }
  double MeanCost() const { return cost_ / static_cast<double>(objective_->size()); }

 private:
  void Linearize() {
    if (!objective_->Linearize(point_, {linearizations_++, parts_}, &at_)) {
      Fail("the cost of the database isn't finite");
    }
  }

  double RidgeCost(const FamilyPoint& point) const {
    return 0.5 * kRidge * point.codes.squaredNorm();
  }

  // False if no step lowers the cost.
  bool TakeStep() {
    for (int k = 0; k < kMaxTries; ++k) {
      const FamilyStep step = DampedStep(point_, at_, kRidge, radius_);
      const FamilyPoint next = {point_.weights + step.change.weights,
                                point_.codes + step.change.codes};
      const double cost = objective_->Cost(next);
      const double gained = cost_ - cost + RidgeCost(point_) - RidgeCost(next);
      const double quality = gained / step.predicted;
      if (!(quality > kMinQuality)) {
        radius_ /= shrink_;
        shrink_ *= 2.0;
        continue;
      }
      radius_ = std::min(kMaxRadius,
                         radius_ / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3.0)));
      shrink_ = 2.0;
      point_ = next;
      cost_ = cost;
      Whiten();
      return true;
    }
    return false;
  }

  // The same networks, by codes of mean 0 and covariance 1.
  void Whiten() {
    if (point_.code_size() == 0) return;
    const VectorXd mean = point_.codes.colwise().mean();
    const MatrixXd centred = point_.codes.rowwise() - mean.transpose();
    MatrixXd covariance =
        centred.transpose() * centred / static_cast<double>(point_.num_materials());
    covariance.diagonal().array() += 1e-12;
    const Eigen::LLT<MatrixXd> factor(covariance);
    point_.weights.col(0) += point_.basis() * mean;
    const MatrixXd basis = point_.basis() * MatrixXd(factor.matrixL());
    point_.weights.rightCols(point_.code_size()) = basis;
    point_.codes = factor.matrixL().solve(centred.transpose()).transpose();
  }

  FamilyObjective* objective_;
  const FamilyOptions& options_;
  const Timer& timer_;
  FamilyPoint point_;
  FamilyLinearization at_;
  std::size_t linearizations_ = 0, parts_ = 1;
  double cost_ = 0.0, radius_ = kFirstRadius, shrink_ = 2.0;
  int iterations_ = 0;
};

// The first principal components of log(1 + f cos theta_i) at the same directions for all: M x code_size, of
// variance 1.
MatrixXd FirstCodes(std::span<const DatabaseMaterial> materials, int code_size) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : DrawSamples(*materials.front().brdf, SampleSet::kTraining,
                                              Sampling::kHighlight, kCommonPairs, kCommonSeed)) {
    pairs.push_back(sample.pair);
  }
  const auto count = static_cast<Index>(materials.size());
  MatrixXd logs(count, 3 * pairs.size());
  ParallelFor(materials.size(), [&](std::size_t m) {
    std::vector<Rgb> values(pairs.size());
    materials[m].brdf->Evaluate(pairs, values);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      for (std::size_t c = 0; c < 3; ++c) {
        logs(static_cast<Index>(m), static_cast<Index>(3 * n + c)) =
            std::log1p(values[n][c] * CosI(pairs[n]));
      }
    }
  });
  logs.rowwise() -= logs.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(logs * logs.transpose());
  return solver.eigenvectors().rightCols(code_size).rowwise().reverse() *
         std::sqrt(static_cast<double>(count));
}

// Random weights for a material like all of them together.
MatrixXd FirstMean(const FitProblem& problem, const FamilyObjective& objective) {
  std::vector<BrdfSample> some;
  for (std::size_t m = 0; m < objective.size(); ++m) {
    const auto first =
        objective.samples(m).first(std::min(kStartSamples, objective.samples(m).size()));
    some.insert(some.end(), first.begin(), first.end());
  }
  const std::vector<double> weights =
      InitialWeights(problem.Shape(), some, problem.sampling.seed, problem.network.initialization);
  return Eigen::Map<const VectorXd>(weights.data(), static_cast<Index>(weights.size()));
}

struct TrainedPoint {
  FamilyPoint point;
  double cost;
  int iterations;
};

// First the mean alone, then with the codes.
TrainedPoint TrainPoint(std::span<const DatabaseMaterial> materials, const FitProblem& problem,
                        const FamilyOptions& options, const Timer& timer,
                        FamilyObjective* objective) {
  const auto count = static_cast<Index>(materials.size());
  Trainer mean(objective, {FirstMean(problem, *objective), MatrixXd(count, 0)}, options, timer);
  mean.Run(std::min(kMeanIterations, options.max_iterations));
  FamilyPoint first = {MatrixXd::Zero(mean.point().weights.rows(), 1 + options.code_size),
                       FirstCodes(materials, options.code_size)};
  first.weights.col(0) = mean.point().weights.col(0);
  Trainer all(objective, std::move(first), options, timer);
  all.Run(options.max_iterations);
  return {all.point(), all.MeanCost(), mean.iterations() + all.iterations()};
}

WeightFamily FamilyAt(const FamilyPoint& point, std::span<const DatabaseMaterial> materials,
                      const NetworkShape& shape) {
  std::vector<DatabaseMember> members;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const VectorXd code = point.codes.row(static_cast<Index>(m));
    members.push_back({materials[m].name, {code.begin(), code.end()}});
  }
  const MatrixXd& weights = point.weights;
  const Index size = weights.rows();
  return WeightFamily(shape, {weights.data(), weights.data() + size},
                      {weights.data() + size, weights.data() + weights.size()}, std::move(members));
}

NeuralBrdf MemberAt(const WeightFamily& family, const std::vector<double>& code) {
  return NeuralBrdf(family.shape(), family.WeightsAt(code));
}

// As MeasureEnergy has it.
double LargestAlbedo(const WeightFamily& family, const std::vector<double>& code) {
  return Largest(LargestAlbedos(AlbedoProfile(MemberAt(family, code), {})));
}

// The member's code fitted again, with the energy term where its albedo exceeds 1 without. Returns the largest
// albedo that is left.
double FitMember(const WeightFamily& family, const FitProblem& problem, Objective* objective,
                 std::vector<double>* code) {
  *code = MinimizeOverCode(family, kRidge, *code, objective).code;
  EnergyConstraints constraints(problem);
  double albedo = constraints.Measure(MemberAt(family, *code)), weight = kFirstEnergyWeight;
  if (albedo < kClearlyConserved) return albedo;
  for (int round = 0; round < kEnergyRounds; ++round) {
    // The constraints see most directions; what a finer check finds between them counts as well.
    const bool seems_conserved = albedo <= kMaxAlbedo;
    if (seems_conserved) albedo = LargestAlbedo(family, *code);
    if (albedo <= 1.0) return albedo;
    constraints.Exchange();
    if (seems_conserved || weight > kLargestEnergyWeight) {
      constraints.LowerTarget(albedo - kTargetAlbedo);
    }
    constraints.Measure(MemberAt(family, *code));  // of the new strata, too
    objective->SetEnergy(weight, constraints.strata());
    *code = MinimizeOverCode(family, kRidge, *code, objective).code;
    albedo = constraints.Measure(MemberAt(family, *code));
    if (weight <= kLargestEnergyWeight) weight *= kEnergyWeightGrowth;
  }
  return LargestAlbedo(family, *code);
}

TrainedFamily Train(std::span<const DatabaseMaterial> materials, const FitProblem& problem,
                    const FamilyOptions& options) {
  const Timer timer;
  FitProblem of_samples = problem;
  of_samples.terms.SetWeight("energy", 0.0);
  FamilyObjective objective(materials, of_samples);
  const auto [point, cost, iterations] =
      TrainPoint(materials, of_samples, options, timer, &objective);
  const WeightFamily family = FamilyAt(point, materials, problem.Shape());
  std::vector<DatabaseMember> members = family.members();
  std::vector<double> albedos(members.size());
  ParallelFor(members.size(), [&](std::size_t m) {
    albedos[m] = FitMember(family, problem, &objective.of(m), &members[m].code);
  });
  return {WeightFamily(problem.Shape(), family.mean(), family.basis(), std::move(members)), cost,
          iterations, timer.Seconds(), std::move(albedos)};
}

void Validate(std::span<const DatabaseMaterial> materials, const FitProblem& problem,
              const FamilyOptions& options) {
  problem.Validate();
  if (problem.terms.loss == Loss::kAbsolute) Fail("loss: absolute isn't a sum of squares");
  const int largest = std::min(WeightFamily::kMaxCodeSize, static_cast<int>(materials.size()) - 1);
  if (options.code_size < 1 || options.code_size > largest) {
    Fail("code_size = ", options.code_size, "; must be 1 to ", largest,
         ", which is less than the number of materials");
  }
  for (const auto& [name, brdf] : materials) {
    if (!brdf->IsIsotropic() && IsIsotropic(*problem.network.encoding)) {
      Fail(name, ": anisotropic; a database of such materials takes --encoding=anisotropic");
    }
    if (brdf->NumChannels() > problem.Shape().num_outputs()) {
      Fail("channels: ", name, " has ", brdf->NumChannels());
    }
  }
}

}  // namespace

FitProblem FamilyProblem() {
  FitProblem problem;
  problem.sampling.samples = kSamplesOfEach;
  problem.terms.loss_scale = kLossScale;
  return problem;
}

TrainedFamily TrainFamily(std::span<const DatabaseMaterial> materials, const FitProblem& problem,
                          const FamilyOptions& options) {
  if (materials.size() < 2) Fail("a database has at least two materials");
  FitProblem settled = problem.For(*materials.front().brdf);
  if (settled.network.channels == 1) settled.network.channels = NetworkShape::kChannels;
  Validate(materials, settled, options);
  std::optional<TrainedFamily> trained;
  WithThreads(options.threads, [&] { trained = Train(materials, settled, options); });
  return *std::move(trained);
}

}  // namespace pbnbrdf
