#pragma once

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/simulation/dexel.h"
#include "fabrication/chisel/check/verify.h"

namespace retrace::fabrication::test {

/// Collects the swept volumes of a program, for dexels.
struct SweptVolumeSink : NcSink {
  explicit SweptVolumeSink(const Machine& m) : machine_of(m) {}
  void motion(const NcMotion& motion, const NcSettings&) override {
    if ((motion.known & 7) != 7 || (motion.moved & 7) == 0) return;
    poses.push_back(machine_from_workpiece(machine_of, rotary_pose(machine_of, motion.to)));
    sweeps.push_back({static_cast<std::uint32_t>(poses.size() - 1), motion.location, false,
                      machine_point(machine_of, motion.from), machine_point(machine_of, motion.to)});
  }
  void dwell(double, const NcLocation&, const AxisPositions&) override {}
  const Machine& machine_of;
  std::vector<SweptVolume> sweeps;
  std::vector<RigidMotion> poses;
};

}  // namespace retrace::fabrication::test
