#pragma once

// The finite discs of source and receiver in photometry, as a weight over the angle between two directions.

#include <vector>

#include "core/angle.h"
#include "geometry/vec.h"

namespace retrace::raytrace {

/// Angular diameters of source and receiver, as discs, seen from the part.
struct PhotometricApertures {
  Angle source;
  Angle receiver;
};

/// 2 J1(x) / x: the Fourier transform of the unit disc over its area.
double disc_transform(double x);

/// What a source and a receiver of finite size make of a direction: the mean over both discs. A pattern moves with its
/// source, so that the mean is a convolution with the density of the difference of two points, one in each disc - the
/// area that the discs share when moved apart, over the product of their areas.
class ApertureKernel {
 public:
  /// \pre both diameters >= 0, one of them > 0, both small angles
  explicit ApertureKernel(const PhotometricApertures& apertures);

  /// Density per steradian at an angular separation. Its integral is 1.
  double per_sr(double separation_rad) const;
  /// Its Fourier transform: what it leaves of a wave over the plane of angles, 1 at 0.
  double transform(double rad_per_rad) const;
  /// Half angle beyond which it is 0.
  double reach_rad() const { return larger_rad_ + smaller_rad_; }

  struct Node {
    geometry::Vec2 offset_rad = geometry::Vec2::Zero();
    double weight = 0.0;
  };
  /// Points for means over the kernel, with weights that add to 1: Gauss-Legendre rules along the radius on either side
  /// of the kink, even steps round. \param detail_rad how far apart the finest details of what is averaged lie, > 0
  std::vector<Node> nodes(double detail_rad) const;

 private:
  double larger_rad_ = 0.0;   ///< radius
  double smaller_rad_ = 0.0;  ///< likewise
};

/// Nodes and weights of the Gauss-Legendre rule on [0, 1]. \pre count > 0
struct GaussRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};
GaussRule gauss_legendre(std::size_t count);

}  // namespace retrace::raytrace
