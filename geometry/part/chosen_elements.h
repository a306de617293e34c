#pragma once

// Determines which facets of a finite part belong to chosen elements.

#include <cstdint>
#include <vector>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_choice.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Table that contains, for each facet, whether it belongs to a chosen element. Elements are chosen by region or at
/// random (ElementChoice), and always as a whole. A choice by region uses the element's centre: the centre of a prism's
/// rectangle or the apex of a cube corner. If the centre is outside the part, the nearest position on the part is used.
///
/// Land (flat surface between elements) belongs to no element. In a choice by region, the position of the land decides
/// whether the land is chosen. In a random choice, land is chosen together with the nearest element. An outer wall is
/// chosen together with the element or land next to it.
///
/// A vertical wall between two elements is a face of the deeper element. It is nevertheless chosen together with the
/// shallower element, because the medium behind the wall is the medium below the shallower element.
class ChosenElements {
 public:
  /// \param part finite array on the plane z = 0; the arrangement must not be `single`
  ChosenElements(const Part& part, const ElementChoice& choice);
  ChosenElements(const ChosenElements&) = delete;
  ChosenElements& operator=(const ChosenElements&) = delete;

  /// Returns true if the space behind a facet belongs to a chosen element.
  /// \param placement index in Part::placements
  /// \param facet index in the facets of that placement's patch
  bool has(std::uint32_t placement, std::uint32_t facet) const {
    return facets_[first_of_placement_[placement] + facet];
  }
  /// Returns true if the element or land next to a position on the outer walls is chosen.
  /// \param position_mm position in the part frame
  bool has_wall_at(const Vec2& position_mm) const;

  /// count() returns the number of chosen elements, and of_all() returns the number of all elements. Elements that the
  /// border cuts are included.
  std::int64_t count() const { return count_; }
  std::int64_t of_all() const { return of_all_; }
  /// contains_all() returns true if all facets are chosen, and is_empty() returns true if no facet is chosen. Land and
  /// walls are included.
  bool contains_all() const { return contains_all_; }
  bool is_empty() const { return is_empty_; }

 private:
  struct LatticeElement {
    std::int64_t i = 0, j = 0;  ///< indices of the lattice period
    std::uint32_t number = 0;   ///< index of the cell within the period
    /// true if the position is within the element; if false, the element is the nearest one
    bool is_within = false;
    Vec2 centre_mm = Vec2::Zero();
  };
  LatticeElement element_at(const Vec2& position_mm) const;
  /// Chooses the facets on a side of a notch or hole if the element or land next to this side is chosen.
  /// \param first index in `facets_` of the first facet of the patch
  void choose_open_side(const SurfacePatch& patch, const Vec2& offset_mm, const PatchCell& cell, std::size_t first);
  bool is_chosen(const LatticeElement& element, const Vec2& position_mm) const;

  ElementChoice choice_;
  PartSpec spec_;
  ArraySheet sheet_;  ///< made from spec_
  Rectangle part_mm_;
  Vec2 inwards_;  ///< distance by which positions on the outer walls are moved inward, mm
  std::vector<std::size_t> first_of_placement_;
  std::vector<bool> facets_;
  std::int64_t count_ = 0;
  std::int64_t of_all_ = 0;
  bool contains_all_ = false;
  bool is_empty_ = false;
};

}  // namespace retrace::geometry
