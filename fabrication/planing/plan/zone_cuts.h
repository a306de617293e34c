#pragma once

// Strokes along the zones of a milled lens, so placed that no more than the tolerance is left between them.

#include <cstdint>
#include <optional>
#include <vector>

#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::fabrication {

/// One stroke along the zones: where the tool's tip is, on the machine's grid.
struct ZoneCut {
  std::size_t zone = 0;
  std::int64_t x = 0;      ///< in steps of the grid, from the middle of the lens
  std::int64_t depth = 0;  ///< likewise, below the face; >= 0
};

/// The tool: a pointed edge, upright towards the outside, and rising towards the middle as steeply as the profile ever
/// does (rounded up to half a degree), so that it never cuts into what it has left.
double flank_slope_of(const ZoneProfile& profile);

/// Where the tool has to go in a zone so that no more than the tolerance is left standing. Depths are positive
/// downwards.
class ZoneCutter {
 public:
  /// \throw InputError if the tolerance is too fine for the grid
  ZoneCutter(const ZoneProfile& profile, double grid_mm, double tolerance_mm);

  double flank_slope() const { return flank_slope_; }
  double grid_mm() const { return grid_mm_; }

  /// First method: at every depth of whole quanta at most one cut, by the three cases of the theory. Nothing if that
  /// leaves more than the tolerance. \param quantum in steps of the grid, >= 1
  std::optional<std::vector<ZoneCut>> by_depths(std::size_t zone, std::int64_t quantum) const;
  /// Second method: outwards, each cut as far from the last as the tolerance lets. \throw InputError as the constructor
  std::vector<ZoneCut> one_after_another(std::size_t zone) const;

  /// Most that stands between two neighbouring cuts of a zone. \param before none: from the zone's inner step
  double left_standing_mm(std::size_t zone, const ZoneCut* before, const ZoneCut& cut) const;

 private:
  std::int64_t first_place(std::size_t zone) const;
  std::int64_t last_place(std::size_t zone) const;
  ZoneCut cut_at(std::size_t zone, std::int64_t x) const;
  std::optional<ZoneCut> at_depth(std::size_t zone, std::int64_t depth, std::int64_t next_depth,
                                  const ZoneCut* before) const;

  const ZoneProfile& profile_;
  double grid_mm_;
  double tolerance_mm_;
  double flank_slope_;
};

}  // namespace retrace::fabrication
