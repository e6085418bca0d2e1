#include "pbnbrdf/brdf/importance_sampler.h"

#include <algorithm>
#include <cmath>

#include "base/pi.h"
#include "brdf/half_vector_cells.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

Vec3 DrawCosine(const std::array<double, 2>& u) {
  const double r = std::sqrt(u[0]), phi = 2.0 * kPi * u[1];
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u[0])};
}

// Two neighbours on an axis of tables, and how far it is from the first to the second.
struct Between {
  int first, second;
  double fraction;
};

Between Neighbours(double position, int count) {
  const double clamped = std::clamp(position, 0.0, count - 1.0);
  const int first = std::min(static_cast<int>(clamped), std::max(count - 2, 0));
  return {first, std::min(first + 1, count - 1), clamped - first};
}

// An incident direction of the tables, and its share in the density for another one.
struct Incident {
  int number;
  double share;
  bool is_turned;  // both directions are to be turned by pi about the normal
};

// Up to two cosines and two azimuths; shares may be 0. Their sum is 1.
class IncidentAround {
 public:
  IncidentAround(const Proposal& p, const Vec3& wi) {
    const Between cosine = Neighbours(wi.z * p.cosines - 1.0, p.cosines);
    if (p.IsIsotropic()) {
      Add(p, cosine, {.number = 0, .share = 1.0, .is_turned = false});
      return;
    }
    // Azimuths repeat after half a turn.
    const double turns = std::atan2(wi.y, wi.x) / kPi;
    const double position = (turns < 0.0 ? turns + 2.0 : turns) * p.azimuths - 0.5;
    const int first = static_cast<int>(std::floor(position));
    for (int k : {0, 1}) {
      const int azimuth = first + k + 2 * p.azimuths;  // >= 0
      const double fraction = position - first;
      Add(p, cosine,
          {.number = azimuth % p.azimuths,
           .share = k == 0 ? 1.0 - fraction : fraction,
           .is_turned = azimuth / p.azimuths % 2 == 1});
    }
  }

  const Incident* begin() const { return incident_.data(); }
  const Incident* end() const { return begin() + count_; }

 private:
  void Add(const Proposal& p, const Between& cosine, const Incident& azimuth) {
    const int row = azimuth.number * p.cosines;
    incident_[count_++] = {row + cosine.first, azimuth.share * (1.0 - cosine.fraction),
                           azimuth.is_turned};
    incident_[count_++] = {row + cosine.second, azimuth.share * cosine.fraction, azimuth.is_turned};
  }

  std::array<Incident, 4> incident_;
  int count_ = 0;
};

// Whether the number is below the share; what it has left is uniform again.
bool Choose(double share, double* number) {
  constexpr double kBelowOne = 1.0 - 1e-16;
  const bool chosen = *number < share;
  *number = chosen ? *number / share : (*number - share) / (1.0 - share);
  *number = std::min(*number, kBelowOne);
  return chosen;
}

void CheckSize(const char* name, std::size_t size, int wanted) {
  if (size != static_cast<std::size_t>(wanted)) Fail(name, ": ", size, " numbers, not ", wanted);
}

void Check(const Proposal& p) {
  if (p.cosines < 1 || p.azimuths < 1 || p.rings < 1 || p.sectors < 2 || p.sectors % 2 != 0) {
    Fail("a proposal has at least 1 cosine, azimuth and ring, and an even number of sectors");
  }
  if (!(p.spread > 0.0 && p.spread <= 1.0)) Fail("spread = ", p.spread, "; must be above 0, to 1");
  CheckSize("cosine_share", p.cosine_share.size(), p.NumIncident());
  CheckSize("cells", p.cells.size(), p.NumIncident() * p.NumCells());
  for (const float share : p.cosine_share) {
    if (!(share >= 0.0f && share <= 1.0f)) Fail("cosine_share: ", share, "; must be 0 to 1");
  }
  for (const float cell : p.cells) {
    if (!(cell >= 0.0f && cell <= 1.0f)) Fail("cells: ", cell, "; must be 0 to 1");
  }
}

}  // namespace

ImportanceSampler::ImportanceSampler(Proposal proposal) : proposal_(std::move(proposal)) {
  Check(proposal_);
  aliases_.resize(proposal_.cells.size());
  const auto count = static_cast<std::size_t>(proposal_.NumCells());
  for (std::size_t first = 0; first < aliases_.size(); first += count) {
    FillAliases({&proposal_.cells[first], count}, {&aliases_[first], count});
  }
}

void ImportanceSampler::FillAliases(std::span<const float> cells, std::span<Alias> aliases) {
  double sum = 0.0;
  for (const float cell : cells) sum += cell;
  if (!(std::abs(sum - 1.0) < 1e-4)) Fail("cells: their sum is ", sum, ", not 1");
  std::vector<double> left;  // to be given away, in units of the mean
  std::vector<std::size_t> less, more;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    left.push_back(cells[k] * static_cast<double>(cells.size()) / sum);
    (left[k] < 1.0 ? less : more).push_back(k);
  }
  while (!less.empty() && !more.empty()) {
    const std::size_t poor = less.back(), rich = more.back();
    less.pop_back();
    aliases[poor] = {.share = left[poor], .other = static_cast<int>(rich)};
    left[rich] -= 1.0 - left[poor];
    if (left[rich] >= 1.0) continue;
    more.pop_back();
    less.push_back(rich);
  }
}

Vec3 ImportanceSampler::Draw(const Vec3& wi, std::array<double, 2> u) const {
  const Proposal& p = proposal_;
  Incident chosen = {};
  double rest = 1.0;
  for (const Incident& incident : IncidentAround(p, wi)) {
    chosen = incident;
    if (Choose(std::min(incident.share / rest, 1.0), &u[0])) break;
    rest -= incident.share;
  }
  if (Choose(p.cosine_share[chosen.number], &u[0])) return DrawCosine(u);

  double inside = u[0] * p.NumCells();
  int cell = std::min(static_cast<int>(inside), p.NumCells() - 1);
  inside -= cell;
  const Alias& alias = aliases_[chosen.number * p.NumCells() + cell];
  if (!Choose(alias.share, &inside)) cell = alias.other;
  const int ring = cell / p.sectors;
  bool other_side = p.IsIsotropic() && Choose(0.5, &inside);
  if (chosen.is_turned) other_side = !other_side;

  const HalfVectorCells cells(p);
  Vec3 h = cells.At((ring + u[1]) / p.rings, (cell % p.sectors + inside) / p.sectors);
  if (other_side) h = p.IsIsotropic() ? Vec3{h.x, -h.y, h.z} : Vec3{-h.x, -h.y, h.z};
  return Reflected(wi, FromFrame(HalfVectorCells::Axis(p, wi), h));
}

double ImportanceSampler::Density(const DirectionPair& pair) const {
  if (!pair.AboveHorizon()) return 0.0;
  const Proposal& p = proposal_;
  const Vec3 sum = pair.wi + pair.wo;
  const Vec3 h = (1.0 / Length(sum)) * sum;
  const double depth = OneMinusCosine(h);
  const Vec3 axis = HalfVectorCells::Axis(p, pair.wi);
  const Vec3 in_frame = FromFrame({axis.x, -axis.y, 0.0}, h);
  const HalfVectorCells cells(p);
  const double v = cells.V(in_frame.x, in_frame.y);
  const int ring = std::min(static_cast<int>(cells.U(depth) * p.rings), p.rings - 1);
  const int sector = std::min(static_cast<int>(v * p.sectors), p.sectors - 1);

  double cosine = 0.0, cell = 0.0;
  for (const Incident& incident : IncidentAround(p, pair.wi)) {
    const double share = p.cosine_share[incident.number];
    const int turned = incident.is_turned ? (sector + p.sectors / 2) % p.sectors : sector;
    const int number = (incident.number * p.rings + ring) * p.sectors + turned;
    cosine += incident.share * share;
    cell += incident.share * (1.0 - share) * p.cells[number];
  }
  const double per_half_vector = cell * p.NumCells() * cells.Density(depth);
  return cosine * pair.wo.z / kPi + per_half_vector / (4.0 * Dot(pair.wi, h));
}

void ImportanceSampler::Sample(std::span<const Vec3> wi, std::span<const std::array<double, 2>> u,
                               std::span<Vec3> wo, std::span<double> pdf) const {
  for (std::size_t n = 0; n < wi.size(); ++n) {
    wo[n] = wi[n].z > 0.0 ? Draw(wi[n], u[n]) : Vec3{0.0, 0.0, 1.0};
    pdf[n] = Density({wi[n], wo[n]});
  }
}

void ImportanceSampler::Pdf(std::span<const DirectionPair> pairs, std::span<double> pdf) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) pdf[n] = Density(pairs[n]);
}

}  // namespace pbnbrdf
