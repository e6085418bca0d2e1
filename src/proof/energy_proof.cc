#include "pbnbrdf/proof/energy_proof.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/parallel.h"
#include "base/timer.h"
#include "proof/network_enclosure.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kChannels = NetworkShape::kChannels;

// Variables of the integrand: t and phi, which are integrated over, and theta_i, and phi_i of anisotropic networks.
enum Variable { kT, kPhi, kThetaI, kPhiI };
constexpr int kIntegrated = 2;

// The first pieces. The merl encoding has kinks at multiples of 1 / kMerlRows of t, where pieces have to end.
constexpr int kFirstT = kMerlRows, kFirstPhi = 8, kFirstThetaI = 64, kFirstPhiI = 8;
// Cells that are refined at a time: enough work for many threads.
constexpr std::size_t kCellsAtATime = 8;
// Of a cell's pieces those that are cut in one go, at least one in so many: the least certain ones.
constexpr std::size_t kCutOneIn = 4;
// An albedo above the limit whose bound is as near as this is given up.
constexpr double kNear = 1e-4;
// The part of the time after which what can't be proved gets as good a bound as possible.
constexpr double kNearOnes = 0.8;
// Slopes that are as good as infinite.
constexpr double kSteepest = 1e100;

template <int D>
struct Box {
  std::array<double, D> center, radius;

  Box Half(int d, int side) const {
    Box half = *this;
    half.radius[d] *= 0.5;
    half.center[d] += (side == 0 ? -1.0 : 1.0) * half.radius[d];
    return half;
  }
};

// The integral of a piece, for each channel: at most constant + slope (wi - centre of the cell).
template <int D>
struct Piece {
  Box<kIntegrated> box;
  std::array<double, kChannels> constant;
  std::array<std::array<double, D - kIntegrated>, kChannels> slope;
  std::array<float, kChannels> estimate;
  // What its size costs, in the channel where it costs most: in t and phi, and in each variable of wi.
  float inner_cost = -1.0f;
  std::array<float, D - kIntegrated> outer_cost;
  int longest;  // the side, of t and phi, that costs most
};

template <int D>
struct Cell {
  Box<D - kIntegrated> box;
  std::vector<Piece<D>> pieces;
  double bound = 0.0, estimate = 0.0;  // of the channel with the largest bound
  double inner_cost = 0.0;             // that of all pieces
  std::array<double, D - kIntegrated> outer_cost = {};
};

// The integrand of all channels is f times this; and the network's inputs.
template <int D>
struct Integrand {
  Enclosure<D> weight;
  Inputs<Enclosure<D>> inputs;
};

template <int D>
Integrand<D> IntegrandOn(Encoding encoding, const Box<D>& box) {
  using V = Enclosure<D>;
  const auto variable = [&](int d) { return V::Variable(d, box.center[d], box.radius[d]); };
  const V t = variable(kT), phi = variable(kPhi), theta_i = variable(kThetaI);
  const V theta_h = (kPi / 2.0) * t * t;
  const V sin_h = sin(theta_h), cos_h = cos(theta_h), sin_i = sin(theta_i), cos_i = cos(theta_i);
  const V sin_phi = sin(phi), cos_phi = cos(phi);
  HalfDiffOf<V> v;
  v.sin_theta = sin_h;
  v.cos_theta = cos_h;
  v.cos_phi = V(1.0);
  v.sin_phi = V(0.0);
  if constexpr (D > kPhiI) {
    const V azimuth = phi + variable(kPhiI);
    v.cos_phi = cos(azimuth);
    v.sin_phi = sin(azimuth);
  }
  v.hx = v.sin_theta * v.cos_phi;
  v.hy = v.sin_theta * v.sin_phi;
  v.dx = sin_i * cos_h * cos_phi - cos_i * sin_h;
  v.dy = -(sin_i * sin_phi);
  v.dz = sin_i * sin_h * cos_phi + cos_i * cos_h;
  const V cos_o = Max(2.0 * v.dz * cos_h - cos_i, V(0.0));
  // d(h) = sin theta_h d(theta_h) d(phi), d(theta_h) = pi t dt.
  return {(4.0 * kPi) * v.dz * cos_o * sin_h * t, Encode(encoding, v)};
}

template <int D>
class Prover {
 public:
  Prover(const NeuralBrdf& network, const EnergyProofOptions& options)
      : network_(network), options_(options) {}

  EnergyProof Run() {
    MakeCells();
    while (timer_.Seconds() < options_.seconds && pieces_ < options_.max_pieces) {
      std::vector<Cell<D>*> worst = NextCells();
      if (worst.empty()) break;
      std::vector<Cell<D>> more(worst.size());
      ParallelFor(worst.size(), [&](std::size_t k) { Refine(worst[k], &more[k]); });
      for (Cell<D>& cell : more) {
        if (!cell.pieces.empty()) cells_.push_back(std::move(cell));
      }
    }
    return Result();
  }

 private:
  static constexpr int kOuter = D - kIntegrated;
  using OuterBox = Box<kOuter>;

  void MakeCells() {
    const int count_phi = kOuter > 1 ? kFirstPhiI : 1;
    cells_.resize(std::size_t(kFirstThetaI * count_phi));
    ParallelFor(cells_.size(), [&](std::size_t k) {
      Cell<D>& cell = cells_[k];
      const double radius = kPi / 4.0 / kFirstThetaI;
      cell.box.radius[0] = radius;
      cell.box.center[0] = radius * (1.0 + 2.0 * double(int(k) % kFirstThetaI));
      if constexpr (kOuter > 1) {
        cell.box.radius[1] = kPi / kFirstPhiI;
        cell.box.center[1] = kPi / kFirstPhiI * (1.0 + 2.0 * double(int(k) / kFirstThetaI));
      }
      std::vector<Box<kIntegrated>> boxes;
      for (int row = 0; row < kFirstT; ++row) {
        for (int column = 0; column < kFirstPhi; ++column) {
          boxes.push_back({{(row + 0.5) / kFirstT, kPi * ((2.0 * column + 1.0) / kFirstPhi - 1.0)},
                           {0.5 / kFirstT, kPi / kFirstPhi}});
        }
      }
      AddPieces(boxes, &cell);
      Sum(&cell);
    });
  }

  // The next cells to refine; none if there is nothing left to do. First those that are nearest to their proof, one
  // after the other, as the pieces of all cells together would need much memory; in the end those with the largest
  // bounds.
  std::vector<Cell<D>*> NextCells() {
    std::vector<Cell<D>*> open;
    pieces_ = 0;
    for (Cell<D>& cell : cells_) {
      if (cell.bound <= kProvedAlbedo) {
        std::vector<Piece<D>>().swap(cell.pieces);
        continue;
      }
      if (cell.estimate > kProvedAlbedo && cell.bound < cell.estimate + kNear) return {};
      pieces_ += cell.pieces.size();
      open.push_back(&cell);
    }
    const std::size_t count = std::min(open.size(), kCellsAtATime);
    const bool near_ones = timer_.Seconds() < kNearOnes * options_.seconds;
    std::partial_sort(open.begin(), open.begin() + std::ptrdiff_t(count), open.end(),
                      [&](const Cell<D>* a, const Cell<D>* b) {
                        return near_ones ? a->bound < b->bound : a->bound > b->bound;
                      });
    open.resize(count);
    return open;
  }

  // Cuts the cell, whose other half `more` becomes, or some of its pieces, whichever makes the bound less certain.
  void Refine(Cell<D>* cell, Cell<D>* more) {
    const auto widest = std::max_element(cell->outer_cost.begin(), cell->outer_cost.end());
    if (*widest > cell->inner_cost) {
      const int d = static_cast<int>(widest - cell->outer_cost.begin());
      std::vector<Box<kIntegrated>> boxes;
      for (const Piece<D>& piece : cell->pieces) boxes.push_back(piece.box);
      more->box = cell->box.Half(d, 1);
      cell->box = cell->box.Half(d, 0);
      cell->pieces.clear();
      AddPieces(boxes, cell);
      AddPieces(boxes, more);
      Sum(more);
    } else {
      CutPieces(cell);
    }
    Sum(cell);
  }

  void CutPieces(Cell<D>* cell) {
    std::vector<Piece<D>>& pieces = cell->pieces;
    const std::size_t count = pieces.size() / kCutOneIn + 1;
    std::nth_element(
        pieces.begin(), pieces.end() - std::ptrdiff_t(count), pieces.end(),
        [](const Piece<D>& a, const Piece<D>& b) { return a.inner_cost < b.inner_cost; });
    std::vector<Box<kIntegrated>> boxes;
    for (std::size_t k = pieces.size() - count; k < pieces.size(); ++k) {
      for (int side : {0, 1}) boxes.push_back(pieces[k].box.Half(pieces[k].longest, side));
    }
    pieces.resize(pieces.size() - count);
    AddPieces(boxes, cell);
  }

  // Computes the pieces; those that are below the horizon for the whole cell are left out.
  void AddPieces(const std::vector<Box<kIntegrated>>& boxes, Cell<D>* cell) {
    NetworkEnclosure<D> enclosure(network_);
    std::vector<Enclosure<D>> weights;
    std::vector<Box<kIntegrated>> batch;
    const auto compute = [&] {
      if (batch.empty()) return;
      computed_ += batch.size();
      enclosure.Run();
      for (std::size_t n = 0; n < batch.size(); ++n) {
        cell->pieces.push_back(MakePiece(enclosure, int(n), weights[n], batch[n], cell->box));
      }
      weights.clear();
      batch.clear();
    };
    for (const Box<kIntegrated>& box : boxes) {
      Box<D> all;
      for (int d = 0; d < D; ++d) {
        all.center[d] = d < kIntegrated ? box.center[d] : cell->box.center[d - kIntegrated];
        all.radius[d] = d < kIntegrated ? box.radius[d] : cell->box.radius[d - kIntegrated];
      }
      const Integrand<D> integrand = IntegrandOn<D>(network_.shape().encoding(), all);
      if (integrand.weight.range.high <= 0.0) continue;
      enclosure.SetInputs(int(batch.size()), integrand.inputs, all.radius);
      weights.push_back(integrand.weight);
      batch.push_back(box);
      if (batch.size() == NetworkEnclosure<D>::kBoxes) compute();
    }
    compute();
  }

  static Piece<D> MakePiece(const NetworkEnclosure<D>& enclosure, int n, const Enclosure<D>& weight,
                            const Box<kIntegrated>& box, const OuterBox& outer) {
    Piece<D> piece;
    piece.box = box;
    const double volume = 4.0 * box.radius[0] * box.radius[1];
    for (int c = 0; c < kChannels; ++c) {
      const Enclosure<D> value = enclosure.Reflectance(n, c) * weight;
      const double mean = enclosure.LargestMean(n, c, kIntegrated) * weight.range.high;
      const double largest = volume * (mean < value.range.high ? mean : value.range.high);
      const double middle = volume * value.center;
      std::array<double, D> costs;
      double linear = middle, reach = 0.0;
      for (int d = 0; d < D; ++d) {
        const Interval& slope = value.slopes[d];
        const double per_radius =
            (d < kIntegrated ? 0.25 : 0.5) * volume * (slope.high - slope.low);
        costs[d] = per_radius * (d < kIntegrated ? box.radius[d] : outer.radius[d - kIntegrated]);
        linear += costs[d];
        if (d < kIntegrated) continue;
        double& middle_slope = piece.slope[c][d - kIntegrated];
        middle_slope = 0.5 * volume * (slope.low + slope.high);
        reach += std::abs(middle_slope) * outer.radius[d - kIntegrated];
      }
      piece.estimate[c] = static_cast<float>(middle);
      piece.constant[c] = linear;
      if (!(linear + reach < largest)) {  // nothing is known of the slopes, or too little
        piece.constant[c] = largest;
        piece.slope[c].fill(0.0);
        costs = Shares(value.slopes, box, outer, largest - middle);
      }
      if (costs[kT] + costs[kPhi] <= piece.inner_cost) continue;
      piece.inner_cost = static_cast<float>(costs[kT] + costs[kPhi]);
      piece.longest = costs[kPhi] > costs[kT] ? kPhi : kT;
      for (int d = 0; d < kOuter; ++d) piece.outer_cost[d] = float(costs[kIntegrated + d]);
    }
    return piece;
  }

  // A cost, shared among the variables as what each can change the value by.
  static std::array<double, D> Shares(const std::array<Interval, D>& slopes,
                                      const Box<kIntegrated>& box, const OuterBox& outer,
                                      double cost) {
    std::array<double, D> shares;
    double sum = 0.0;
    for (int d = 0; d < D; ++d) {
      const double steepest = std::max(std::abs(slopes[d].low), std::abs(slopes[d].high));
      const double radius = d < kIntegrated ? box.radius[d] : outer.radius[d - kIntegrated];
      shares[d] = radius * (steepest < kSteepest ? steepest : kSteepest);  // also of NaN
      sum += shares[d];
    }
    for (double& share : shares) share *= cost / sum;
    return shares;
  }

  static void Sum(Cell<D>* cell) {
    std::array<double, kChannels> bounds = {}, estimates = {};
    std::array<std::array<double, kOuter>, kChannels> slopes = {};
    cell->inner_cost = 0.0;
    cell->outer_cost.fill(0.0);
    for (const Piece<D>& piece : cell->pieces) {
      for (int c = 0; c < kChannels; ++c) {
        bounds[c] += piece.constant[c];
        estimates[c] += double(piece.estimate[c]);
        for (int d = 0; d < kOuter; ++d) slopes[c][d] += piece.slope[c][d];
      }
      cell->inner_cost += double(piece.inner_cost);
      for (int d = 0; d < kOuter; ++d) cell->outer_cost[d] += double(piece.outer_cost[d]);
    }
    const std::array<double, kOuter> spreads = cell->outer_cost;
    cell->bound = -1.0;
    for (int c = 0; c < kChannels; ++c) {
      double bound = bounds[c];
      std::array<double, kOuter> costs = spreads;
      for (int d = 0; d < kOuter; ++d) {
        const double reach = std::abs(slopes[c][d]) * cell->box.radius[d];
        bound += reach;
        costs[d] += reach;
      }
      if (bound <= cell->bound) continue;
      cell->bound = bound;
      cell->estimate = estimates[c];
      cell->outer_cost = costs;
    }
  }

  static double PartOfHemisphere(const OuterBox& box) {
    const double part =
        std::cos(box.center[0] - box.radius[0]) - std::cos(box.center[0] + box.radius[0]);
    if constexpr (kOuter > 1) return part * box.radius[1] / kPi;
    return part;
  }

  EnergyProof Result() const {
    const auto worst =
        std::max_element(cells_.begin(), cells_.end(),
                         [](const Cell<D>& a, const Cell<D>& b) { return a.bound < b.bound; });
    EnergyProof proof;
    proof.bound = worst->bound;
    proof.estimate = worst->estimate;
    proof.theta_i = worst->box.center[0];
    if constexpr (kOuter > 1) proof.phi_i = worst->box.center[1];
    for (const Cell<D>& cell : cells_) {
      if (cell.bound <= kProvedAlbedo) proof.proved_part += PartOfHemisphere(cell.box);
    }
    proof.cells = cells_.size();
    proof.pieces = computed_;
    proof.seconds = timer_.Seconds();
    return proof;
  }

  const NeuralBrdf& network_;
  const EnergyProofOptions options_;
  const Timer timer_;
  std::vector<Cell<D>> cells_;
  std::size_t pieces_ = 0;                 // that are there
  std::atomic<std::size_t> computed_ = 0;  // of all times
};

}  // namespace

EnergyProof ProveEnergy(const NeuralBrdf& network, const EnergyProofOptions& options) {
  if (network.IsIsotropic()) return Prover<kThetaI + 1>(network, options).Run();
  return Prover<kPhiI + 1>(network, options).Run();
}

}  // namespace pbnbrdf
