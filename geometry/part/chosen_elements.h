#pragma once

// Which facets of a finite part belong to chosen elements.

#include <cstdint>
#include <vector>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_choice.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// The facets of the elements that a choice names, for tracers to look up. An element is chosen as a whole, by where
/// its middle lies: a prism's in the middle of its rectangle, a cube corner's over its apex, and of one that the border
/// cuts where in the part that is nearest. Land, which belongs to no element, is chosen by its own place in a region,
/// and with the nearest element where chance decides; so are the outer walls.
class ChosenElements {
 public:
  /// \param part a finite array on the plane z = 0, not `single`
  ChosenElements(const Part& part, const ElementChoice& choice);
  ChosenElements(const ChosenElements&) = delete;
  ChosenElements& operator=(const ChosenElements&) = delete;

  /// Whether a facet, the `facet`th of the patch of the `placement`th placement, is one of theirs.
  bool has(std::uint32_t placement, std::uint32_t facet) const {
    return facets_[first_of_placement_[placement] + facet];
  }
  /// The same of a place on the outer walls, in the part frame.
  bool has_wall_at(const Vec2& place_mm) const;

  /// Elements, whole and cut, that are chosen, and all.
  std::int64_t count() const { return count_; }
  std::int64_t of_all() const { return of_all_; }
  /// Whether everything is chosen, and nothing, land and walls included.
  bool is_everything() const { return is_everything_; }
  bool is_nothing() const { return is_nothing_; }

 private:
  struct Place {
    std::int64_t i = 0, j = 0;  ///< period of the lattice
    std::uint32_t number = 0;   ///< cell in it
    bool is_within = false;     ///< the element; else it is the nearest one
    Vec2 middle_mm = Vec2::Zero();
  };
  Place element_at(const Vec2& place_mm) const;
  bool is_chosen(const Place& element, const Vec2& place_mm) const;

  ElementChoice choice_;
  PartSpec spec_;
  ArraySheet sheet_;  ///< of spec_
  Rectangle part_mm_;
  Vec2 inwards_;  ///< from the border, mm
  std::vector<std::size_t> first_of_placement_;
  std::vector<bool> facets_;
  std::int64_t count_ = 0;
  std::int64_t of_all_ = 0;
  bool is_everything_ = false;
  bool is_nothing_ = false;
};

}  // namespace retrace::geometry
