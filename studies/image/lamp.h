#pragma once

// Lamps by their luminous intensity in every direction, as photometric files tell it.

#include <string>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Luminous intensity over planes through an axis, and angles within each plane; linear between. In the lamp's frame:
/// x to the right and y up for somebody who looks out of the lamp along its own axis, which is -z.
class LuminousIntensity {
 public:
  /// CIE 121:1996, LM-75-01. Planes of C turn about the lamp's axis: C = 0 to the right, 90 up, and gamma is measured
  /// from the axis. Planes of A turn about the vertical: X to the right, and Y is the elevation. Planes of B turn about
  /// the horizontal axis across: V upwards, and H to the right within them.
  enum class Planes { c, a, b };

  /// \pre planes and angles ascend, cd has a row of angles for each plane; of `c` one plane, which is all of them, or
  /// planes from 0 to 360
  LuminousIntensity(Planes kind, std::vector<double> planes_deg, std::vector<double> angles_deg,
                    std::vector<double> cd);

  /// In a direction, of any length above 0; 0 outside the planes and angles.
  double cd(const geometry::Vec3& direction) const;
  /// The flux into all directions, in lm.
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
  std::vector<double> cd_;  ///< row by row
};

/// A lamp as a file tells it.
struct PhotometricLamp {
  std::string name;   ///< of the file, as given
  std::string title;  ///< that the file gives; empty if none
  LuminousIntensity intensity;
  double printed_lumens = 0.0;  ///< that the file says the lamp sends out; 0: it says none
};

/// A direction in the frame of a lamp whose axis is turned down (negative: up), by the direction in the frame of what
/// it stands on; both with x to the right, y up and -z ahead.
geometry::Vec3 from_aimed(const geometry::Vec3& direction, double down_deg);

}  // namespace retrace::studies
