// Paths at an entrance face that scatters. These member functions of PathWalker are not used for clean faces.
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

/// Returns the rays, inside and outside the part, into which a scattering entrance face splits the incident ray.
const SoiledReturn& PathWalker::soiled(const Ray& ray) {
  surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
  from_soiled_.clear();
  setup_.soiled->meet(ray, setup_.policy.split_power, random, from_soiled_);
  tally_.other[Account::absorbed] += from_soiled_.absorbed;
  tally_.other[Account::truncated] += from_soiled_.truncated;
  return from_soiled_;
}

/// Processes light in the air that meets the face.
void PathWalker::enter_soiled(const State& state) {
  for (const Ray& ray : soiled(state).rays) {
    State next = state;
    static_cast<Ray&>(next) = ray;
    if (ray.inside)
      pending_.push_back(next);
    else
      send_back(next, ray.light, ray.direction);
  }
}

bool PathWalker::meet_soiled_entrance(const State& state) {
  for (const Ray& ray : soiled(state).rays) {
    State next = state;
    static_cast<Ray&>(next) = ray;
    next.source = {};
    if (ray.inside)
      pending_.push_back(next);
    else
      leave(next, ray.light, ray.direction);
  }
  return false;
}

}  // namespace retrace::raytrace
