#pragma once

// The faces around each column of an infinite array, and the search for the face that a ray meets next.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/cells/cell_array.h"
#include "raytrace/cells/ray_batch.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

/// Facets and borders of the columns of an array.
class ColumnFaces {
 public:
  /// Neighbouring column on the other side of a border, or of an interval of a border.
  struct Exit {
    lanes::Label crossing = 0;         ///< label of rays that continue in the neighbouring column
    std::optional<lanes::Label> wall;  ///< label of rays that meet the wall; set if the surfaces may differ in height
    std::uint32_t column = 0;          ///< the neighbouring column
    Vec2 shift_mm = Vec2::Zero();      ///< shift from this column's coordinates to the neighbour's
    Vec3 wall_normal = Vec3::Zero();   ///< unit normal of the wall; points out of the part
  };

  explicit ColumnFaces(const CellArray& array);

  /// Moves the rays of a batch to their next faces and stores these faces in RayBatch::hits.
  /// \return the power that the material absorbs on the path
  double advance(const LightSetup& setup, RayBatch& batch) const;
  /// Returns the neighbouring columns that the rays of a stream can reach.
  const std::vector<Exit>& exits(const StreamKey& key) const { return side_of(key).exits; }
  geometry::FacetRole role(std::uint32_t column) const { return columns_[column].role; }
  /// Returns the index of the facet of a column whose normal is nearest to `normal`.
  std::size_t facet_of(std::uint32_t column, const Vec3& normal) const;
  const Vec3& normal(std::uint32_t column, std::size_t facet) const { return columns_[column].facets[facet].normal; }
  /// Returns the frame of a facet with a form, or nothing for other facets.
  const std::optional<FacetFrame>& frame(std::uint32_t column, std::size_t facet) const {
    return columns_[column].frames[facet];
  }

 private:
  /// Neighbours of a column for the rays on one side of its surface.
  struct Side {
    std::vector<lanes::Border> borders;  ///< borders with several neighbours or a wall
    std::vector<Exit> exits;
  };
  struct Column {
    std::vector<lanes::Plane> facets;
    std::vector<lanes::Plane> borders;
    std::vector<lanes::LinearForm> heights;
    std::vector<std::optional<FacetFrame>> frames;
    geometry::FacetRole role = geometry::FacetRole::retro_facet;
    std::array<Side, 2> sides;  ///< [0] for rays below the surface, [1] for rays inside the part
  };

  Side side_of_column(const CellArray::Column& column, bool inside) const;
  const Side& side_of(const StreamKey& key) const { return columns_[key.column].sides[key.inside() ? 1 : 0]; }

  std::vector<Column> columns_;
};

}  // namespace retrace::raytrace
