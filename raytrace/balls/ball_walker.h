#pragma once

// Traces a single light path through balls and their mirrors, from sphere to sphere by analytical intersection.

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "raytrace/balls/ball_lattice.h"
#include "raytrace/light/light.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

/// Traces light through a layer of balls and adds its power to the ledger. Both branches of an interface (reflected and
/// transmitted light) are traced if each has at least PathPolicy::split_power. Otherwise, one branch is chosen at
/// random and receives the total power. All surfaces are spheres about the centres of balls, and intersections are
/// computed analytically in double precision.
class BallWalker {
 public:
  BallWalker(const BallLayer& layer, const LightSetup& setup, const PathPolicy& policy, Tally& tally)
      : layer_(layer), lattice_(layer), setup_(setup), policy_(policy), tally_(tally) {}

  /// Key and counters of the random numbers of a path.
  struct RandomCounters {
    RandomKey key;
    std::uint32_t replicate = 0;
    std::uint32_t ray = 0;
  };
  /// Traces light of power 1 from a point in the air above the layer.
  void trace(const Vec3& origin_mm, const Vec3& direction, const Light& light, const RandomCounters& chance);

 private:
  enum class Medium { air, ball, spacer };
  /// Ray in the queue. Its position is relative to the centre of its ball.
  struct Ray {
    Medium medium = Medium::air;
    BallIndex ball;
    bool at_ball = false;  ///< true if a ray in air starts from the surface of the ball
    bool entered = false;  ///< true if the light has been inside a ball
    Vec3 position_mm = Vec3::Zero();
    Vec3 direction = Vec3::Zero();
    Light light;
  };
  struct Interface {
    Medium reflected;
    Medium transmitted;
    double index_ratio;
  };

  void follow(const Ray& ray);
  void follow_in_air(const Ray& ray);
  void follow_in_ball(const Ray& ray);
  void follow_in_spacer(const Ray& ray);
  /// Processes a smooth interface between two transparent media. Both branches are queued.
  /// \param normal unit normal, which may point to either side
  void meet(const Ray& ray, const Vec3& position_mm, const Vec3& normal, const Interface& between);
  void meet_back(const Ray& ray, const Vec3& position_mm, const Vec3& normal);
  void meet_mirror(Ray ray, const Vec3& position_mm, const Vec3& normal, bool from_ball);
  void leave(const Ray& ray);
  void enqueue(Ray ray);
  /// Queues both branches of an interface (reflected and refracted), or a random one of them with the power of both.
  void enqueue_branches(Ray one, Ray other);
  bool is_mirrored(const Vec3& normal) const;

  const BallLayer& layer_;
  BallLattice lattice_;
  const LightSetup& setup_;
  const PathPolicy& policy_;
  Tally& tally_;
  std::vector<Ray> waiting_;
  RandomCounters random_;
  std::uint32_t draws_ = 0;
};

}  // namespace retrace::raytrace
