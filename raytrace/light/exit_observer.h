#pragma once

// Interface for what records the light that leaves a part, such as detectors and files of rays.

#include "raytrace/faces/surface_ray.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/light.h"

namespace retrace::raytrace {

/// Light that leaves the part for good.
struct Departure {
  Account account = Account::returned_elsewhere;  ///< retroreflected: inside the widest cone
  const Vec3& position;   ///< on the face, relative to its centre in x and y; of an infinite part in some period of it
  const Vec3& direction;  ///< in air, a unit vector
  const Light& light;     ///< in units of that of the path when it began
  Vec2 shift_mm = Vec2::Zero();  ///< of an infinite part: from `position` to where the path really is

  bool is_through_entrance() const { return account != Account::side_exit && account != Account::transmitted; }
};

/// Told of light that leaves the part, path by path. Of what the entrance face sends back at once it is told where that
/// face is curved or scatters, or where light comes from elsewhere than the beam; else that is the same for all paths.
class ExitObserver {
 public:
  virtual ~ExitObserver() = default;
  virtual void leaves(const Departure& departure) = 0;
};

}  // namespace retrace::raytrace
