// Paths at an entrance face that scatters. These member functions of PathWalker are not used for clean faces.
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

/// Returns the rays, inside and outside the part, into which a scattering entrance face splits the incident ray.
const EntranceScatter& PathWalker::scatter_at_face(const Ray& ray) {
  surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
  scatter_.clear();
  setup_.contaminated_entrance->meet(ray, setup_.policy.split_power, random, scatter_);
  tally_.other[Account::absorbed] += scatter_.absorbed;
  tally_.other[Account::truncated] += scatter_.truncated;
  return scatter_;
}

/// Processes light in the air that meets the face.
void PathWalker::enter_contaminated(const State& state) {
  for (const Ray& ray : scatter_at_face(state).rays) {
    State next = state;
    static_cast<Ray&>(next) = ray;
    if (ray.inside)
      pending_.push_back(next);
    else
      send_back(next, ray.light, ray.direction);
  }
}

bool PathWalker::meet_contaminated_entrance(const State& state) {
  for (const Ray& ray : scatter_at_face(state).rays) {
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
