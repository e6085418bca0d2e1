// albedo.h: the directional albedo a(wi) = integral of f cos_o dwo (eq. 2), by quadrature.
#pragma once

#include <numbers>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// n > 0 nodes in (0, 1) and weights of the Gauss-Legendre rule: the integrals over [0, 1] of
// polynomials up to degree 2n - 1 are exact.
struct GaussLegendre {
  explicit GaussLegendre(int n);
  std::vector<double> nodes, weights;
};

struct AlbedoNode {
  DirectionPair pair;
  double weight;  // > 0, includes cos_o and the solid angle
};

// Sum of weight * f(pair) = a(wi), within 0.03 % with 64 x 32 nodes for lobes from Lambertian to 0.1
// degree wide, at up to 89.5 degrees of incidence, and within 1e-6 with 160 x 96.
//
// The nodes are stratified in the half vector, dense about the mirror direction, where a sharp lobe
// falls between the points of any grid that is uniform in wo: theta_h = theta_max u^3, with
// dwo = 4 (wi.h) dwh and cos_o = 0 at theta_max(phi_h). Towards grazing incidence theta_max falls
// steeply where h tilts sideways, 90 degrees from the plane of incidence: phi_h is divided there,
// and crowds there as x^2 (3 - 2 x) does. u and x have Gauss-Legendre rules.
class AlbedoQuadrature {
 public:
  // n_theta >= 1, n_phi >= 2
  AlbedoQuadrature(int n_theta, int n_phi);

  // theta_h in the cells between the rows of a MERL table, n_theta >= 1 nodes in each, twice as many
  // in the first ones. Tables and networks with the merl encoding have kinks at the rows, over which
  // other rules converge slowly. What may be left are narrow ridges over phi_h, at grazing incidence.
  static AlbedoQuadrature OnMerlRows(int n_theta, int n_phi);

  // wi: of unit length, above the horizon. The nodes are above it, too.
  std::vector<AlbedoNode> Nodes(const Vec3& wi) const;

  // The same, part by part: part k, up to NumParts(), has the nodes of one phi_h. Appends them.
  int NumParts() const { return static_cast<int>(phi_.size()); }
  void AddPart(const Vec3& wi, int k, std::vector<AlbedoNode>* nodes) const;

 private:
  // A node over theta_h.
  struct Tilt {
    double sin_h, cos_h;
    double weight;  // dtheta_h
  };

  static void AddCell(double first, double last, int power, const GaussLegendre& rule,
                      std::vector<Tilt>* tilts);
  const GaussLegendre& RuleOfRow(int row) const;

  const GaussLegendre *x_, *x_of_first_rows_;
  std::vector<Tilt> rows_;                 // of whole rows of a MERL table; else none
  std::vector<std::size_t> row_begin_;     // in rows_, of each row and of the end
  std::vector<double> phi_, phi_weights_;  // phi_h from the plane of incidence on, radians
};

Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, const AlbedoQuadrature& quadrature);
Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, int n_theta = 128, int n_phi = 64);

// Incident directions of a profile, and how well their albedos are known. Each is integrated with 64
// x 32 nodes and then by AlbedoQuadrature::OnMerlRows with more and more, until two agree within a
// tolerance, or it is below `refine_above`, or what the largest albedo of all is at least, by a wide
// margin, four times their difference. Where single precision (Brdf::SinglePrecision) agrees with
// double within 1e-5, it is used for all that this can't change.
struct AlbedoGrid {
  int angles = 300;  // theta_i: dense towards the last
  double last_angle = 0.5 * std::numbers::pi;
  int azimuths = 16;  // phi_i, of anisotropic Brdfs
  double refine_above = 1.0;
  double tolerance = 1e-6, excess_tolerance = 0.01;  // or so much of what the albedo is above 1
  int n_theta = 2, n_phi = 80;                       // to begin with
  int refinements = 7;                               // at most; each has half as many more each way
};

struct IncidentAlbedo {
  double theta_i, phi_i;  // radians
  double solid_angle;     // that it stands for, sr; 0: not of the grid, added
  Rgb albedo;
};

// The directional albedos at incident directions all over the hemisphere, in parallel, sorted by
// phi_i and then theta_i. Added to the grid are the largest of the local maxima over theta_i, which
// mostly lie between its directions, and the last angle.
std::vector<IncidentAlbedo> AlbedoProfile(const Brdf& brdf, const AlbedoGrid& grid);

// The largest of each channel, at least 0.
Rgb LargestAlbedos(const std::vector<IncidentAlbedo>& profile);

// Where a channel's albedo is largest; the first such direction. The profile mustn't be empty.
const IncidentAlbedo& LargestIn(const std::vector<IncidentAlbedo>& profile, int channel);

}  // namespace pbnbrdf
