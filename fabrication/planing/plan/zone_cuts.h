#pragma once

// Places strokes along the zones of a milled lens so that the material that remains between them is within the
// tolerance.

#include <cstdint>
#include <optional>
#include <vector>

#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::fabrication {

/// Position of the tool's tip in one stroke along the zones, on the machine's grid.
struct ZoneCut {
  std::size_t zone = 0;
  std::int64_t x = 0;      ///< position in steps of the grid, from the centre of the lens
  std::int64_t depth = 0;  ///< depth in steps of the grid, below the face; >= 0
};

/// Returns the slope of the flank of the tool. The tool has a pointed edge. It is vertical towards the outside of the
/// lens. Towards the centre, its flank is as steep as the maximum slope of the profile, rounded up to half a degree. It
/// therefore never cuts below the profile.
double flank_slope_of(const ZoneProfile& profile);

/// Computes the strokes in a zone that leave no more material than the tolerance. Depths are positive downwards.
class ZoneCutter {
 public:
  /// \pre `profile` outlives this object
  ZoneCutter(const ZoneProfile& profile, double grid_mm, double tolerance_mm);

  double flank_slope() const { return flank_slope_; }
  double grid_mm() const { return grid_mm_; }

  /// First method: at most one cut at every depth that is a multiple of the depth increment (quantum), by the three
  /// cases of docs/theory/planing.md. Returns nothing if these cuts leave more than the tolerance.
  /// \param quantum depth increment in steps of the grid, >= 1
  std::optional<std::vector<ZoneCut>> cuts_at_depths(std::size_t zone, std::int64_t quantum) const;
  /// Second method: cuts from the inside to the outside. Each cut is as far from the previous one as the tolerance
  /// allows.
  /// \throw InputError if the tolerance is too small for the grid
  std::vector<ZoneCut> sequential_cuts(std::size_t zone) const;

  /// Returns the maximum height of the material that remains between two neighbouring cuts of a zone.
  /// \param before previous cut. If it is null, the material between the inner step of the zone and the first cut is
  ///        measured
  double cusp_height_mm(std::size_t zone, const ZoneCut* before, const ZoneCut& cut) const;

 private:
  std::int64_t first_grid_index(std::size_t zone) const;
  std::int64_t last_grid_index(std::size_t zone) const;
  ZoneCut cut_at(std::size_t zone, std::int64_t x) const;
  std::optional<ZoneCut> at_depth(std::size_t zone, std::int64_t depth, std::int64_t next_depth,
                                  const ZoneCut* before) const;

  const ZoneProfile& profile_;
  double grid_mm_;
  double tolerance_mm_;
  double flank_slope_;
};

}  // namespace retrace::fabrication
