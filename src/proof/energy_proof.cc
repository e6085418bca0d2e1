#include "pbnbrdf/proof/energy_proof.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/pi.h"
#include "base/timer.h"
#include "proof/piece.h"

namespace pbnbrdf {
namespace {

constexpr int kChannels = NetworkShape::kChannels;

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

template <int D>
struct Cell {
  Box<D - kIntegrated> box;
  std::vector<Piece<D>> pieces;
  double bound = 0.0, estimate = 0.0;  // of the channel with the largest bound
  double inner_cost = 0.0;             // that of all pieces
  std::array<double, D - kIntegrated> outer_cost = {};
};

template <int D>
class Prover {
 public:
  Prover(const NeuralBrdf& network, const EnergyProofOptions& options)
      : network_(network), options_(options) {}

  EnergyProof Run() {
    MakeCells();
    while (timer_.Seconds() < options_.seconds && pieces_ < options_.max_pieces) {
      if (options_.on_progress) options_.on_progress(ProvedPart(), timer_.Seconds());
      std::vector<Cell<D>*> next = NextCells();
      if (next.empty()) break;
      std::vector<Cell<D>> more(next.size());
      ParallelFor(next.size(), [&](std::size_t k) { Refine(next[k], &more[k]); });
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

  double ProvedPart() const {
    double part = 0.0;
    for (const Cell<D>& cell : cells_) {
      if (cell.bound <= kProvedAlbedo) part += PartOfHemisphere(cell.box);
    }
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
    proof.proved_part = ProvedPart();
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
