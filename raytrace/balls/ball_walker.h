#pragma once

// Follows one light path through balls and their mirrors, from sphere to sphere in closed form.

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "raytrace/balls/ball_lattice.h"
#include "raytrace/light/light.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

/// Follows light through a layer of balls and books where it ends: both ways at an interface while either branch
/// carries PathPolicy::split_power, then one of them by chance with the power of both. All surfaces are spheres about
/// the centres of balls, and all steps are closed forms in double precision.
class BallWalker {
 public:
  BallWalker(const BallLayer& layer, const LightSetup& setup, const PathPolicy& policy, Tally& tally)
      : layer_(layer), lattice_(layer), setup_(setup), policy_(policy), tally_(tally) {}

  /// Which random numbers a path takes.
  struct Chance {
    RandomKey key;
    std::uint32_t replicate = 0;
    std::uint32_t ray = 0;
  };
  /// Follows light of power 1 from a place in the air above the layer.
  void trace(const Vec3& origin_mm, const Vec3& direction, const Light& light, const Chance& chance);

 private:
  enum class Medium { air, ball, spacer };
  /// A piece of light that waits to be followed. Positions are relative to the centre of the ball it is at.
  struct Ray {
    Medium medium = Medium::air;
    BallIndex ball;
    bool at_ball = false;  ///< in air: starts from its surface
    bool entered = false;  ///< has been inside a ball
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
  /// A smooth interface of two clear media: both branches are kept. \param normal unit, on either side
  void meet(const Ray& ray, const Vec3& position_mm, const Vec3& normal, const Interface& between);
  void meet_back(const Ray& ray, const Vec3& position_mm, const Vec3& normal);
  void meet_mirror(Ray ray, const Vec3& position_mm, const Vec3& normal, bool from_ball);
  void leave(const Ray& ray);
  void keep(Ray ray);
  /// Both branches, or one of them with the power of both.
  void keep_branches(Ray one, Ray other);
  bool is_mirrored(const Vec3& normal) const;

  const BallLayer& layer_;
  BallLattice lattice_;
  const LightSetup& setup_;
  const PathPolicy& policy_;
  Tally& tally_;
  std::vector<Ray> waiting_;
  Chance chance_;
  std::uint32_t draws_ = 0;
};

}  // namespace retrace::raytrace
