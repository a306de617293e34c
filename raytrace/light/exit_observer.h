#pragma once

// Interface of objects that record the light that leaves a part, such as detectors and files of rays.

#include "raytrace/light/ledger.h"
#include "raytrace/light/light.h"

namespace retrace::raytrace {

/// Light that leaves the part and does not meet it again.
struct ExitEvent {
  Account account = Account::returned_elsewhere;  ///< `retroreflected` means inside the widest cone
  /// Point where the light leaves the part or, if it crosses shells, the outermost shell. The point is relative to the
  /// centre of the entrance face in x and y. In an infinite part, the point may be in any period.
  const Vec3& position;
  const Vec3& direction;             ///< unit vector in air
  const Light& light;                ///< its power is a fraction of the power at the start of the path
  Vec2 shift_mm = Vec2::Zero();      ///< in an infinite part, vector from `position` to the real position of the path
  bool is_front_reflection = false;  ///< true if the outer side of the entrance face reflected the light

  bool is_through_entrance() const { return account != Account::side_exit && account != Account::transmitted; }
};

/// Receives the light that leaves the part, path by path. Light that the entrance face reflects from outside is
/// normally the same for all paths and is not reported. It is reported if the face is curved or scatters, and for rays
/// that have individual directions of incidence.
class ExitObserver {
 public:
  virtual ~ExitObserver() = default;
  virtual void on_exit(const ExitEvent& event) = 0;
};

}  // namespace retrace::raytrace
