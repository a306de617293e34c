#pragma once

// Heights z(x, y) that are given by polynomials on rectangles, for the surfaces of CAD files.

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/jets.h"
#include "core/math/partials.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Degree of the polynomial of a patch in x and in y.
inline constexpr int kPatchDegree = 7;
inline constexpr int kPatchTerms = (kPatchDegree + 1) * (kPatchDegree + 1);

/// Polynomial on a rectangle: sum C_ij u^i v^j. u and v are -1 to 1 on the rectangle.
struct HeightPatch {
  Vec2 centre_mm = Vec2::Zero();
  Vec2 half_mm = Vec2::Ones();                     ///< half of the size of the rectangle
  std::array<double, kPatchTerms> coefficients{};  ///< in mm, sorted by i, then by j

  /// Returns z in mm with all derivatives of the type T.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const {
    const T u = (x_mm - centre_mm.x()) * (1.0 / half_mm.x());
    const T v = (y_mm - centre_mm.y()) * (1.0 / half_mm.y());
    constexpr int kTerms = kPatchDegree + 1;
    const double* row = coefficients.data() + kPatchDegree * kTerms;
    T sum = jets::horner(row, kTerms, v);
    for (int i = kPatchDegree - 1; i >= 0; --i) {
      row -= kTerms;
      sum = sum * u + jets::horner(row, kTerms, v);
    }
    return sum;
  }
};

/// Node of a binary tree of rectangles. A node either divides its rectangle at a line of constant x or y, or refers to
/// a patch.
struct PatchNode {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  int axis = -1;                 ///< 0: divided at x = split_mm; 1: divided at y = split_mm; -1: not divided
  std::uint32_t first = kNone;   ///< node below the line; of a node that is not divided: the patch, or kNone
  std::uint32_t second = kNone;  ///< node above the line
  double split_mm = 0.0;
};

/// Heights of a smooth face. They continue a small distance beyond the borders of the face.
struct PatchTree {
  std::vector<PatchNode> nodes;  ///< the first node is the root; each node refers only to later nodes
  std::vector<HeightPatch> patches;

  /// Returns the patch whose rectangle contains a point, or null if there is none.
  const HeightPatch* patch_at(const Vec2& point_mm) const;
};

/// Border of a face in plan: closed polygons, in which the face is on the left of each side. The polygons of faces that
/// have a common edge contain the same points along this edge.
using FaceBorder = std::vector<std::vector<Vec2>>;

/// Surface z(x, y) that consists of one or more smooth faces. At the edge between two faces, the slope may change
/// abruptly. The borders of the faces determine which face gives the height at a point. In a gap between two faces, it
/// is the nearer face. Beyond the outer border, the surface is continued along its tangent.
class PatchSurface {
 public:
  /// \param borders border of each face
  /// \pre trees and borders have the same size, which is at least 1
  PatchSurface(std::vector<PatchTree> faces, std::vector<FaceBorder> borders);

  /// Returns z in mm with all derivatives of the type T.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const {
    const Vec2 point(jets::value_of(x_mm), jets::value_of(y_mm));
    if (const HeightPatch* const patch = faces_[face_at(point)].patch_at(point)) return patch->evaluate(x_mm, y_mm);
    const TangentBeyond tangent = tangent_beyond(point);
    return (x_mm - tangent.at_mm.x()) * tangent.slope.x() + (y_mm - tangent.at_mm.y()) * tangent.slope.y() +
           tangent.height_mm;
  }

  /// Returns true if a point is inside the border of a face or on it.
  bool covers(const Vec2& point_mm, double tolerance_mm) const;
  std::size_t face_count() const { return faces_.size(); }
  std::size_t patch_count() const;

 private:
  /// Side of a border between two heights y. The face `face` is on the right of the side; -1: there is no face.
  struct SideInSlab {
    double lower_x_mm = 0.0;
    double upper_x_mm = 0.0;
    int face = -1;
  };

  /// Tangent plane at the point of the border that is nearest to a point beyond the border.
  struct TangentBeyond {
    Vec2 at_mm = Vec2::Zero();
    double height_mm = 0.0;
    Vec2 slope = Vec2::Zero();
  };

  void make_slabs();
  TangentBeyond tangent_beyond(const Vec2& point_mm) const;
  std::size_t face_at(const Vec2& point_mm) const;

  std::vector<PatchTree> faces_;
  std::vector<FaceBorder> borders_;
  std::vector<Vec2> coarse_border_;  // points of the borders from which tangents continue the surface
  // Slabs between successive heights y of corners. Sides do not cross each other within a slab.
  std::vector<double> slab_y_mm_;               // borders of the slabs, ascending; empty for a single face
  std::vector<std::vector<SideInSlab>> slabs_;  // sides of each slab, sorted by x
};

}  // namespace retrace::geometry
