#pragma once

// Effect of the finite discs of source and receiver in photometry, as a weight function of the angle between
// directions.

#include <vector>

#include "core/angle.h"
#include "geometry/vec.h"

namespace retrace::raytrace {

/// Angular diameters of the discs of source and receiver, as seen from the part.
struct PhotometricApertures {
  Angle source;
  Angle receiver;
};

/// Returns 2 J1(x) / x, the Fourier transform of the unit disc divided by its area.
double disc_transform(double x);

/// Weight function for averages over the discs of source and receiver. If the source moves, the pattern of the returned
/// light moves with it. The average is therefore a convolution with the density of the difference between two random
/// points, one in each disc. This density is the area of the overlap of the displaced discs divided by the product of
/// their areas.
class ApertureKernel {
 public:
  /// \pre both diameters >= 0, one of them > 0, both small angles
  explicit ApertureKernel(const PhotometricApertures& apertures);

  /// Returns the density per steradian at an angular separation. Its integral is 1.
  double per_sr(double separation_rad) const;
  /// Returns the Fourier transform of the density in the plane of angles. It is 1 at the frequency 0.
  /// \param rad_per_rad angular frequency: phase per angle
  double transform(double rad_per_rad) const;
  /// Returns the angular separation above which the density is 0.
  double reach_rad() const { return larger_rad_ + smaller_rad_; }
  double source_radius_rad() const { return source_rad_; }
  double receiver_radius_rad() const { return receiver_rad_; }

  struct Node {
    geometry::Vec2 offset_rad = geometry::Vec2::Zero();
    double weight = 0.0;
  };
  /// Returns points for averages over the kernel, with weights that add up to 1. They are Gauss-Legendre points along
  /// the radius, on both sides of the kink of the density, and uniform steps in azimuth.
  /// \param detail_rad width of the finest details of the averaged function, > 0
  std::vector<Node> nodes(double detail_rad) const;

 private:
  double larger_rad_ = 0.0;   ///< radius of the larger disc
  double smaller_rad_ = 0.0;  ///< radius of the smaller disc
  double source_rad_ = 0.0;   ///< radius of the source's disc
  double receiver_rad_ = 0.0;
};

/// Nodes and weights of the Gauss-Legendre rule on [0, 1].
struct GaussRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};
/// \pre count > 0
GaussRule gauss_legendre(std::size_t count);

}  // namespace retrace::raytrace
