// Paths at an entrance face that scatters: what a clean one never calls of PathWalker.
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

/// What a scattering entrance face makes of a ray.
const SoiledReturn& PathWalker::soiled(const Ray& ray) {
  surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
  from_soiled_.clear();
  setup_.soiled->meet(ray, setup_.policy.split_power, random, from_soiled_);
  tally_.other[Account::absorbed] += from_soiled_.absorbed;
  tally_.other[Account::truncated] += from_soiled_.truncated;
  return from_soiled_;
}

/// Light in the air that has come to the face.
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
