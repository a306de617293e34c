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

void PathWalker::enter_soiled(const Vec2& entry_mm) {
  for (const Ray& ray : soiled({-setup_.to_source, setup_.incident, false, false}).rays) {
    if (!ray.inside) {
      book_front(setup_, ray, tally_);
      if (observer_ != nullptr)
        observer_->leaves({entry_mm.x(), entry_mm.y(), setup_.thickness_mm}, ray.direction, ray.light.power());
      continue;
    }
    State& state = pending_.emplace_back();
    static_cast<Ray&>(state) = ray;
    state.position = {entry_mm.x(), entry_mm.y(), setup_.thickness_mm};
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
