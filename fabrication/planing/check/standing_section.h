#pragma once

// What stands of a round blank while a turning tool goes along its section: heights at places of the radius.

#include <cstdint>
#include <vector>

#include "fabrication/planing/check/swept_nose.h"

namespace retrace::fabrication {

/// The blank's section from the axis to the rim, its face at z = 0, at places of equal distance. What a move takes at a
/// place is that of the nose about its straight line; upright lines of a pointed tool count for the places beside them.
class StandingSection {
 public:
  StandingSection(double end_mm, double spacing_mm, double nose_mm);

  /// A straight move of the nose's lowest point. The part turns: beyond the axis it cuts on the other side.
  /// \param who is remembered where it took something \return the most that it took along Z
  double cut(const SectionPoint& from, const SectionPoint& to, std::int32_t who);

  const std::vector<double>& heights_mm() const { return heights_; }
  double place_mm(std::size_t index) const { return spacing_ * static_cast<double>(index); }
  /// Who took the last of a place; -1: nobody.
  std::int32_t who(std::size_t index) const { return who_[index]; }

 private:
  double cut_side(const SectionPoint& from, const SectionPoint& to, std::int32_t who);
  template <class Height>
  double lower(double from_mm, double to_mm, std::int32_t who, const Height& height);

  double spacing_;
  double nose_;
  std::vector<double> heights_;
  std::vector<std::int32_t> who_;
};

}  // namespace retrace::fabrication
