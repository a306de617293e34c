#pragma once

#include <algorithm>
#include <vector>

#include "raytrace/light/exit_observer.h"

namespace retrace::testing {

/// Records the light that leaves through the entrance face or the entrance surface.
struct ExitRecorder : raytrace::ExitObserver {
  struct Exit {
    raytrace::Vec3 position;
    raytrace::Vec3 direction;
    double power;
  };
  std::vector<Exit> all;
  void on_exit(const raytrace::ExitEvent& event) override {
    if (event.is_through_entrance()) all.push_back({event.position, event.direction, event.light.power()});
  }
  const Exit& strongest() const {
    return *std::max_element(all.begin(), all.end(), [](const Exit& a, const Exit& b) { return a.power < b.power; });
  }
};

}  // namespace retrace::testing
