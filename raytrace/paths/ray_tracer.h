#pragma once

// Traces single rays that come from anywhere, such as those of a file, and gives every ray that leaves the part.

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/light.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

struct PathSetup;

/// A ray on its way, in the part frame.
struct IncidentRay {
  Vec3 position_mm = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ();  ///< unit
  Light light;                      ///< of any power >= 0, `s_axis` across the direction
  std::uint32_t optics = 0;         ///< at its wavelength: a number that RayTracer::add() gave
};

/// A ray that has left the part for good, or missed it.
struct LeavingRay {
  std::uint32_t incident = 0;  ///< number of the incident ray
  Account account = Account::retroreflected;
  Vec3 position_mm = Vec3::Zero();  ///< on the face that it left through last
  Vec3 direction = Vec3::UnitZ();
  Light light;
};

/// Where the power of rays has gone, in their units.
struct RayLedger {
  double incident = 0.0;
  Ledger ledger;        ///< of what met the part
  double missed = 0.0;  ///< never met it
  std::uint64_t rays = 0;
  std::uint64_t rays_missed = 0;
  std::array<std::uint64_t, kAccountCount> leaving = {};  ///< rays that left, by account
  /// Sums over rays, for the error of what is retroreflected: squared powers; these times the share of each ray that
  /// came back; times its square.
  double squares = 0.0;
  double squares_back = 0.0;
  double squares_back2 = 0.0;

  void add(const RayLedger& more);
  /// Returns the standard error of the retroreflected fraction of the power. The fraction is a mean over independent
  /// rays, weighted by power. The error includes an allowance for paths that no ray has taken, see with_unseen().
  double std_error() const;
};

/// What became of some rays.
struct TracedRays {
  std::vector<LeavingRay> leaving;    ///< in the order of the incident rays
  std::vector<std::uint32_t> missed;  ///< numbers of the incident rays that never met the part
  RayLedger ledger;
};

/// One part, at as many wavelengths as are added. Results do not depend on the number of threads.
class RayTracer {
 public:
  /// \param part, entrance_face as those of MonteCarlo; they must outlive the tracer
  /// \param cone_deg half angle round the way back of each ray within which light counts as retroreflected
  RayTracer(const geometry::Part& part, const geometry::Entrance* entrance_face, double cone_deg,
            const PathPolicy& policy, std::uint32_t seed);
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;
  ~RayTracer();

  /// One more wavelength. Not while trace() runs. \return its number, from 0
  std::uint32_t add(const Optics& optics);

  /// Traces in the calling thread's TBB arena. Random choices of a ray depend on the seed and its number alone.
  /// \param first number of the first ray, counted over all calls
  /// \throw BudgetError if power is lost: a ray missed every face from inside
  /// or splits into too many rays
  /// \throw TraceBudgetError if the rays that leave exceed the memory budget
  TracedRays trace(std::span<const IncidentRay> rays, std::uint64_t first, const Cancellation* cancel) const;

 private:
  struct Scene;
  class Walk;

  std::unique_ptr<Scene> scene_;
};

}  // namespace retrace::raytrace
