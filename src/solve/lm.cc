// Levenberg-Marquardt on the normal equations of an Objective.
//
// The steps are those of Ceres' trust region [1]. The linear algebra is this project's own: Debian's
// libceres is compiled for any x86-64, and its factorisation would take most of the time.
//
// [1] S. Agarwal, K. Mierle and others. Ceres Solver, version 2.1. Its user guide names the sources,
//     foremost K. Madsen, H. Nielsen, O. Tingleff. Methods for Non-Linear Least Squares Problems. 2004
//     (the radius), and A. Conn, N. Gould, P. Toint. Trust-Region Methods. SIAM 2000, algorithm 10.1.2
//     (steps that may raise the cost).
// [2] M. Transtrum, J. Sethna. Improvements to the Levenberg-Marquardt Algorithm for Nonlinear Least-Squares
//     Minimization. arXiv:1201.5885, 2012: steps with geodesic acceleration.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/cholesky.h"
#include "pbnbrdf/base/error.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr double kMinRadius = 1e-32, kMaxRadius = 1e16;  // Ceres' defaults
// Of the predicted one, for a step to be taken; Ceres' default.
constexpr double kMinDecrease = 1e-3;
constexpr int kMaxRisingSteps = 5;  // Ceres' default (max_consecutive_nonmonotonic_steps)
constexpr double kMaxRise = 4.0;    // of the cost over the least one so far
// The damping is relative to the diagonal of J'J in weights scaled by 1 / (1 + |J_i|), and there at
// least this: Ceres' default (min_lm_diagonal).
constexpr double kMinScaledDiagonal = 1e-6;

// A step d + a / 2 follows the residuals' bend if the acceleration a is at most so long, against d, in the
// norm of the damping; else it is d. 0.75 in [2].
constexpr double kMaxAcceleration = 0.75;
// Rounding of J'J bounds the radius: once A + D didn't factor, it stays below a part of that one, which grows
// with each step taken.
constexpr double kRadiusAfterFailure = 1.0 / 3.0, kRadiusRelief = 1.1;

// Says how good a step is. It compares with a cost of up to kMaxRisingSteps steps before, so that the cost may
// rise for a while.
class StepJudge {
 public:
  explicit StepJudge(double cost)
      : least_(cost), current_(cost), reference_(cost), candidate_(cost) {}

  double least() const { return least_; }

  // The decrease of the cost divided by the predicted one: that of this step, or of all steps since the
  // reference if it is better. -1 where the cost isn't finite or beyond kMaxRise.
  double Quality(double cost, double predicted) const {
    if (!(cost <= kMaxRise * least_)) return -1.0;
    return std::max((current_ - cost) / predicted,
                    (reference_ - cost) / (since_reference_ + predicted));
  }

  void Take(double cost, double predicted) {
    current_ = cost;
    since_candidate_ += predicted;
    since_reference_ += predicted;
    if (cost < least_) {
      least_ = candidate_ = cost;
      since_candidate_ = 0.0;
      rising_steps_ = 0;
    } else {
      ++rising_steps_;
      if (cost > candidate_) {
        candidate_ = cost;
        since_candidate_ = 0.0;
      }
    }
    if (rising_steps_ == kMaxRisingSteps) {
      reference_ = candidate_;
      since_reference_ = since_candidate_;
    }
  }

 private:
  double least_, current_, reference_, candidate_;
  double since_reference_ = 0.0, since_candidate_ = 0.0;  // predicted decreases
  int rising_steps_ = 0;
};

class LevenbergMarquardt {
 public:
  // accelerates: steps with geodesic acceleration.
  LevenbergMarquardt(Objective* objective, bool accelerates, const StageOptions& options,
                     std::vector<double>* best)
      : objective_(objective),
        accelerates_(accelerates),
        options_(options),
        best_(best),
        x_(*best),
        trial_(*best),
        step_(best->size()),
        cholesky_(static_cast<int>(best->size())),
        radius_(options.first_radius) {}

  StageResult Run() {
    if (!Linearize(x_, &at_)) {
      result_.cost = std::numeric_limits<double>::infinity();
      Stop(Termination::kDiverged, "the cost or a derivative isn't finite at the first weights");
      return result_;
    }
    StepJudge judge(at_.cost);
    result_.cost = at_.cost;
    FixScale();
    while (MayContinue(judge.least()) && HasGradient()) {
      ++result_.iterations;
      double predicted = 0.0;
      double cost = std::numeric_limits<double>::infinity();
      const bool has_step = ComputeStep(&predicted);
      if (has_step) cost = objective_->Cost(trial_.data());
      const double quality = judge.Quality(cost, predicted);
      // Both: steps of part of the curvature may by chance neither raise nor lower the cost.
      const double change = std::max(std::abs(at_.cost - cost), predicted);
      if (!(quality > kMinDecrease)) {
        ++(has_step ? result_.rejected_steps : result_.failed_factorizations);
        if (!has_step && objective_->SumCurvatureInDouble()) {
          if (!Relinearize()) break;
          continue;
        }
        if (!has_step) max_radius_ = kRadiusAfterFailure * radius_;
        ShrinkRadius();
        if (Stalled(change)) break;
        continue;
      }
      const double tolerated = options_.function_tolerance * at_.cost;
      if (!Linearize(trial_, &next_)) {
        ++result_.failed_factorizations;
        ShrinkRadius();
        continue;
      }
      std::swap(at_, next_);
      x_ = trial_;
      judge.Take(cost, predicted);
      if (cost <= judge.least()) Keep(cost);
      GrowRadius(quality);
      if (change <= tolerated) {
        StopAtTolerance(change);
        break;
      }
    }
    return result_;
  }

  double radius() const { return radius_; }

 private:
  // J'J from another part of the samples each time.
  bool Linearize(const std::vector<double>& x, Linearization* at) {
    const std::size_t parts = objective_->num_samples() / options_.curvature_samples;
    const CurvaturePart part = {linearizations_++, std::max<std::size_t>(parts, 1)};
    if (!objective_->Linearize(x.data(), part, at)) return false;
    part_ = part;
    return true;
  }

  // At the same weights. False if something isn't finite.
  bool Relinearize() {
    return Linearize(x_, &at_) ||
           Stop(Termination::kDiverged, "the cost or a derivative isn't finite");
  }

  bool MayContinue(double cost) {
    if (options_.on_iteration && !options_.on_iteration(result_.iterations, cost)) {
      return Stop(Termination::kInterrupted, "the user stopped it");
    }
    if (result_.iterations >= options_.max_iterations) {
      return Stop(Termination::kMaxIterations, "the iterations are used up");
    }
    if (options_.seconds_left && options_.seconds_left() <= 0.0) {
      return Stop(Termination::kMaxSeconds, "the time is used up");
    }
    return true;
  }

  bool Stop(Termination termination, const std::string& message) {
    result_.termination = termination;
    result_.message = message;
    return false;
  }

  void StopAtTolerance(double change) {
    Stop(Termination::kConverged, StrCat("|cost change|: ", change, " <= ",
                                         options_.function_tolerance, " * cost ", at_.cost));
  }

  // Where it is 0 no step leads anywhere: at a perfect fit, or with units that are all dead.
  bool HasGradient() {
    const bool is_zero = std::all_of(at_.gradient.begin(), at_.gradient.end(),
                                     [](double slope) { return slope == 0.0; });
    return !is_zero || Stop(Termination::kConverged, "the gradient is 0");
  }

  // When the radius is spent, or the cost moves by no more than rounding makes it.
  bool Stalled(double change) {
    if (radius_ < kMinRadius) {
      Stop(Termination::kConverged, StrCat("trust region radius ", radius_, " < ", kMinRadius));
      return true;
    }
    if (change <= options_.function_tolerance * at_.cost) {
      StopAtTolerance(change);
      return true;
    }
    return false;
  }

  void Keep(double cost) {
    *best_ = x_;
    result_.cost = cost;
  }

  double Diagonal(std::size_t i) const { return at_.hessian[i * x_.size() + i]; }

  // Of the weights, from the first Jacobian, for good.
  void FixScale() {
    scale_.resize(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) scale_[i] = 1.0 / (1.0 + std::sqrt(Diagonal(i)));
  }

  // step = -(A + D)^-1 g, trial = x + step. False if A + D isn't positive definite or the step
  // isn't finite. predicted: the decrease of the cost that the linear model promises, > 0.
  bool ComputeStep(double* predicted) {
    const std::size_t p = x_.size();
    damping_.resize(p);
    for (std::size_t i = 0; i < p; ++i) {
      const double scaled = scale_[i] * scale_[i] * Diagonal(i);
      damping_[i] = std::max(scaled, kMinScaledDiagonal) / (radius_ * scale_[i] * scale_[i]);
      double* row = cholesky_.row(static_cast<int>(i));
      std::copy_n(&at_.hessian[i * p], i + 1, row);
      row[i] += damping_[i];
      step_[i] = -at_.gradient[i];
    }
    if (!cholesky_.Factor()) return false;
    cholesky_.Solve(step_.data());
    // -(g's + s'As / 2) with As = -g - Ds: half of (s'Ds - g's).
    *predicted = 0.0;
    for (std::size_t i = 0; i < p; ++i) {
      *predicted += 0.5 * step_[i] * (damping_[i] * step_[i] - at_.gradient[i]);
      trial_[i] = x_[i] + step_[i];
    }
    if (accelerates_) Accelerate();
    return std::isfinite(*predicted) && *predicted > 0.0;
  }

  // trial += a / 2, a = -(A + D)^-1 J'r'' with r'' along the step, unless a is too long.
  void Accelerate() {
    std::vector<double> acceleration = objective_->Curve(x_.data(), step_.data(), part_);
    cholesky_.Solve(acceleration.data());
    double length = 0.0, step_length = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      length += damping_[i] * acceleration[i] * acceleration[i];
      step_length += damping_[i] * step_[i] * step_[i];
    }
    if (!(length <= kMaxAcceleration * kMaxAcceleration * step_length)) return;
    for (std::size_t i = 0; i < x_.size(); ++i) trial_[i] -= 0.5 * acceleration[i];
  }

  void ShrinkRadius() {
    radius_ /= shrink_;
    shrink_ *= 2.0;
  }

  void GrowRadius(double quality) {
    radius_ /= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3));
    max_radius_ = std::min(kRadiusRelief * max_radius_, kMaxRadius);
    radius_ = std::min(radius_, max_radius_);
    shrink_ = 2.0;
  }

  Objective* objective_;
  const bool accelerates_;
  const StageOptions& options_;
  std::vector<double>* best_;
  std::vector<double> x_, trial_, step_, scale_, damping_;
  CurvaturePart part_;  // of at_
  Linearization at_, next_;
  Cholesky cholesky_;
  std::size_t linearizations_ = 0;
  double radius_, max_radius_ = kMaxRadius, shrink_ = 2.0;
  StageResult result_;
};

}  // namespace

// Diverged if the objective isn't finite at the start; converged at once where its gradient is 0.
StageResult MinimizeLm(const StageInput& input, const StageOptions& options,
                       std::vector<double>* weights) {
  LevenbergMarquardt solver(input.objective, input.options.acceleration, options, weights);
  StageResult result = solver.Run();
  result.last_radius = solver.radius();
  return result;
}

}  // namespace pbnbrdf
