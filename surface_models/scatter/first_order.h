#pragma once

// Light that a slightly rough interface between dielectrics scatters to both sides, by perturbation theory to first
// order in its heights. Theory and sources: docs/theory/scatter.md, "First order at a dielectric".

#include <Eigen/Core>
#include <array>
#include <complex>
#include <memory>

#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Amplitudes or coherency of two components of the field, s before p.
using Polarisation2 = Eigen::Matrix2cd;

/// A plane interface between two dielectrics, one of whose sides light comes from. Wave vectors along the interface are
/// in units of that of vacuum: index times sine.
class DielectricInterface {
 public:
  /// \param index_from of the side the light comes from, > 0; \param index_to of the other, > 0
  DielectricInterface(double index_from, double index_to);

  /// What a wave in the interface feels of a field of unit amplitude: the components that are continuous there, of the
  /// electric field along the interface (s and p) and of the displacement across it over both indices.
  struct Vertex {
    std::complex<double> s, p, across;
  };
  /// Field at the interface of light that arrives with the wave vector `k` along it. \param k 0 <= k < index_from
  Vertex arriving(double k) const;
  /// Field at the interface of the reversed light of what leaves on the side of the lobe. \param k less than its index
  Vertex leaving(double k, Lobe lobe) const;

  /// Scattered amplitudes per amplitude that comes in: with F, a height spectrum N of variance s^2 and the coherency J
  /// of incident light of power 1, the power that scatters into d2k is (2 pi s / w)^2 trace(F J F^+) N(k_out - k_in)
  /// d2k. Rows: s and p of what leaves, with s = k x z over |k| and p = direction x s; columns those of what arrives.
  /// \param along direction of the wave vector that arrives, a unit vector, also where k_in is 0
  Polarisation2 amplitudes(double k_in, const Vec2& along, const Vec2& k_out, Lobe lobe) const;

  /// Upper bound of trace(F J F^+) over all directions on both sides, added where there are two.
  double bound(double k_in, const Polarisation2& coherency) const;

  double index_from() const { return index_from_; }
  double index_to() const { return index_to_; }
  double index_of(Lobe lobe) const { return lobe == Lobe::reflection ? index_from_ : index_to_; }
  /// Component of the wave vector across the interface, on the side of the lobe.
  std::complex<double> across(double k, Lobe lobe) const;

 private:
  double index_from_, index_to_;
  double contrast_;  ///< index_to^2 - index_from^2
};

/// Gaussian roughness of one correlation length on such an interface: how much it scatters of light of power 1, summed
/// over both sides, by angle of incidence. A table of integrals, made once.
class FirstOrderShare {
 public:
  /// \param correlation_length where the autocorrelation is 1/e, in units of w / (2 pi), > 0
  FirstOrderShare(const DielectricInterface& interface, double correlation_length);

  /// Of s and of p, in units of (2 pi Sq / w)^2. \param k_in index times sine of the incidence
  std::array<double, 2> at(double k_in) const;

 private:
  struct Table;
  std::shared_ptr<const Table> table_;
};

}  // namespace retrace::surface_models
