#pragma once

// Records the moves of a program.

#include <string>
#include <string_view>
#include <vector>

#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication::test {

struct Record : NcSink {
  struct Dwell {
    double seconds = 0.0;
    NcLocation place;
  };

  void motion(const NcMotion& motion, const NcSettings& now) override {
    motions.push_back(motion);
    settings = now;
  }
  void dwell(double seconds, const NcLocation& place, const AxisPositions&) override {
    dwells.push_back({seconds, place});
  }

  std::vector<NcMotion> motions;
  std::vector<Dwell> dwells;
  NcSettings settings;
  NcEnd end;
};

inline Record record_of(std::string_view text, NcDialect dialect, const NcTexts& texts = {}) {
  Record record;
  record.end = run_nc(parse_nc(text, "p", dialect, texts), record);
  return record;
}

}  // namespace retrace::fabrication::test
