#pragma once

// Traces individual rays with any position and direction, such as those of a file. Returns every ray that leaves the
// part.

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

/// A ray that is traced, in the part frame.
struct IncidentRay {
  Vec3 position_mm = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ();  ///< unit vector
  Light light;                      ///< light of any power >= 0; `s_axis` is perpendicular to `direction`
  std::uint32_t optics = 0;         ///< number of the wavelength, as returned by RayTracer::add()
};

/// A ray that leaves the part and does not meet it again.
struct LeavingRay {
  std::uint32_t incident = 0;  ///< index of the incident ray
  Account account = Account::retroreflected;
  Vec3 position_mm = Vec3::Zero();  ///< point on the last face through which the ray left
  Vec3 direction = Vec3::UnitZ();
  Light light;
};

/// Sums of the power of rays by account, in the units of the incident rays.
struct RayLedger {
  double incident = 0.0;
  Ledger ledger;        ///< light of rays that met the part
  double missed = 0.0;  ///< power of rays that never met the part
  std::uint64_t rays = 0;
  std::uint64_t rays_missed = 0;
  std::array<std::uint64_t, kAccountCount> leaving = {};  ///< number of leaving rays by account
  /// Sums over rays for the standard error of the retroreflected fraction. With the power p of a ray and its
  /// retroreflected fraction f, they are the sums of p^2, of p^2 f, and of p^2 f^2.
  double squares = 0.0;
  double squares_back = 0.0;
  double squares_back2 = 0.0;

  void add(const RayLedger& more);
  /// Returns the standard error of the retroreflected fraction of the power. This fraction is a mean over independent
  /// rays, weighted with their powers. The error includes an allowance for paths that no ray has taken
  /// (with_unsampled_paths()).
  double std_error() const;
};

/// Results of the rays of one call of RayTracer::trace().
struct TracedRays {
  std::vector<LeavingRay> leaving;    ///< leaving rays, in the order of the incident rays
  std::vector<std::uint32_t> missed;  ///< indices of the incident rays that never met the part
  RayLedger ledger;
};

/// Ray tracer of one part for several wavelengths. Results do not depend on the number of threads.
class RayTracer {
 public:
  /// \param part the part, which must outlive the tracer
  /// \param entrance_face curved entrance face as in MonteCarlo, which must outlive the tracer; null for the plane face
  /// \param cone_deg half angle of the acceptance cone about the direction opposite to each ray
  RayTracer(const geometry::Part& part, const geometry::Entrance* entrance_face, double cone_deg,
            const PathPolicy& policy, std::uint32_t seed);
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;
  ~RayTracer();

  /// Adds a wavelength.
  /// \pre trace() is not running
  /// \return the number of the wavelength, from 0
  std::uint32_t add(const Optics& optics);

  /// Traces rays with the TBB threads of the calling thread's arena. Random choices of a ray depend only on the seed
  /// and the number of the ray.
  /// \param first number of the first ray, counted over all calls
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a ray splits into too
  ///        many rays
  /// \throw TraceBudgetError if the leaving rays exceed the memory budget
  TracedRays trace(std::span<const IncidentRay> rays, std::uint64_t first, const Cancellation* cancel) const;

 private:
  struct Scene;
  class Walk;

  std::unique_ptr<Scene> scene_;
};

}  // namespace retrace::raytrace
