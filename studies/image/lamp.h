#pragma once

// Lamps that are described by their luminous intensity in every direction, as in photometric files.

#include <string>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Luminous intensity in planes through an axis and at angles within each plane, with linear interpolation. The frame
/// of the lamp is that of a person who looks out of the lamp along its axis: x to the right, y up, and the axis is -z.
class LuminousIntensity {
 public:
  /// Types of planes (CIE 121:1996, LM-75-01). Planes of type C contain the lamp's axis: C = 0 is to the right, 90 is
  /// up, and gamma is the angle from the axis. Planes of type A contain the vertical: X is to the right, and Y is the
  /// elevation. Planes of type B contain the horizontal axis perpendicular to the lamp's axis: V is upwards, and H is
  /// to the right within a plane.
  enum class Planes { c, a, b };

  /// \pre planes and angles ascend, and cd has a row of angles for each plane; type C has planes from 0 to 360 degrees,
  /// or one plane that applies to all
  LuminousIntensity(Planes kind, std::vector<double> planes_deg, std::vector<double> angles_deg,
                    std::vector<double> cd);

  /// Returns the intensity in a direction, which need not be a unit vector. Returns 0 outside the planes and angles.
  double cd(const geometry::Vec3& direction) const;
  /// Returns the total luminous flux in lm.
  double lumens() const;
  double largest_cd() const;

  Planes kind() const { return kind_; }
  const std::vector<double>& planes_deg() const { return planes_deg_; }
  const std::vector<double>& angles_deg() const { return angles_deg_; }

 private:
  double in_plane(std::size_t plane, double angle_deg) const;
  double flux_of_plane(std::size_t plane) const;

  Planes kind_;
  std::vector<double> planes_deg_;
  std::vector<double> angles_deg_;
  std::vector<double> cd_;  ///< intensities, row by row
};

/// Lamp as described by a file.
struct PhotometricLamp {
  std::string name;   ///< name of the file, as given
  std::string title;  ///< title in the file; empty if there is none
  LuminousIntensity intensity;
  double printed_lumens = 0.0;  ///< luminous flux as given in the file; 0 if it is not given
};

/// Transforms a direction to the frame of a lamp whose axis is rotated downwards (negative: upwards). Both frames have
/// x to the right, y up and -z ahead.
geometry::Vec3 from_aimed(const geometry::Vec3& direction, double down_deg);

}  // namespace retrace::studies
