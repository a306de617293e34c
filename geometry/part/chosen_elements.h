#pragma once

// Which facets of a finite part belong to chosen elements.

#include <cstdint>
#include <vector>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_choice.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Table that contains, for each facet, whether it belongs to a chosen element. An element is chosen as a whole. A
/// choice by region uses the position of the element's centre: the centre of a prism's rectangle or the apex of a cube
/// corner. If the centre is outside the part, the position on the part nearest to it is used.
///
/// Land belongs to no element. In a choice by region, the position of land itself decides whether the land is chosen.
/// In a random choice, land is chosen together with the nearest element. An outer wall is chosen together with the
/// element or land next to it.
///
/// A vertical wall between two elements is a face of the deeper element, but is chosen together with the shallower one:
/// the medium outside the wall is the medium below the shallower element.
class ChosenElements {
 public:
  /// \param part a finite array on the plane z = 0, not `single`
  ChosenElements(const Part& part, const ElementChoice& choice);
  ChosenElements(const ChosenElements&) = delete;
  ChosenElements& operator=(const ChosenElements&) = delete;

  /// Returns true if the space behind a facet belongs to a chosen element.
  /// \param placement index in Part::placements
  /// \param facet index in the facets of that placement's patch
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
