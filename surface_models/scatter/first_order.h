#pragma once

// Light that a slightly rough interface between dielectrics scatters to both sides, by first-order perturbation theory
// in the heights. Theory and sources: docs/theory/scatter.md, "First order at a dielectric".

#include <Eigen/Core>
#include <array>
#include <complex>
#include <memory>

#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Amplitudes or coherency matrix of two field components, s before p.
using Polarisation2 = Eigen::Matrix2cd;

/// Plane interface between two dielectrics, for light from one of the sides. Wave vectors along the interface are in
/// units of the vacuum wave number: index times sine.
class DielectricInterface {
 public:
  /// \param index_from index on the side of the incident light, > 0
  /// \param index_to index on the other side, > 0
  DielectricInterface(double index_from, double index_to);

  /// Field at the interface for light of unit amplitude. The components are those that are continuous across the
  /// interface: the tangential electric field (s and p), and the normal displacement divided by both indices.
  struct Vertex {
    std::complex<double> s, p, across;
  };
  /// Returns the field at the interface for incident light whose wave vector along the interface is `k`.
  /// \param k 0 <= k < index_from
  Vertex arriving(double k) const;
  /// Returns the field at the interface for light that arrives in the reversed direction of a scattered wave. The
  /// scattered wave is on the side of the lobe.
  /// \param k magnitude of the scattered wave vector along the interface; less than the index on this side
  Vertex leaving(double k, Lobe lobe) const;

  /// Returns the matrix F of scattered amplitudes per incident amplitude. Let N be a height spectrum whose integral is
  /// the variance of the heights, and J the coherency of incident light of power 1. The power that is scattered into
  /// d2k is then (2 pi / w)^2 trace(F J F^+) N(k_out - k_in) d2k.
  /// The rows of F are s and p of the scattered light, where s = k x z / |k| and p = direction x s. The columns are s
  /// and p of the incident light.
  /// \param along unit vector of the incident wave vector along the interface, also if k_in is 0
  Polarisation2 amplitudes(double k_in, const Vec2& along, const Vec2& k_out, Lobe lobe) const;

  /// Returns an upper bound of trace(F J F^+) over all directions on both sides. If there are scattered waves on both
  /// sides, the bounds of the sides are added.
  double bound(double k_in, const Polarisation2& coherency) const;

  double index_from() const { return index_from_; }
  double index_to() const { return index_to_; }
  double index_of(Lobe lobe) const { return lobe == Lobe::reflection ? index_from_ : index_to_; }
  /// Returns the component of the wave vector normal to the interface, on the side of the lobe.
  std::complex<double> across(double k, Lobe lobe) const;

 private:
  double index_from_, index_to_;
  double contrast_;  ///< index_to^2 - index_from^2
};

/// Fraction of the power that an interface with Gaussian roughness scatters, summed over both sides, as a function of
/// the angle of incidence. The integrals are tabulated in the constructor.
class FirstOrderFraction {
 public:
  /// \param correlation_length distance at which the autocorrelation is 1/e, in units of w / (2 pi), > 0
  FirstOrderFraction(const DielectricInterface& interface, double correlation_length);

  /// Returns the fractions for s and p, in units of (2 pi Sq / w)^2.
  /// \param k_in index times sine of the angle of incidence
  std::array<double, 2> at(double k_in) const;

 private:
  struct Table;
  std::shared_ptr<const Table> table_;
};

}  // namespace retrace::surface_models
