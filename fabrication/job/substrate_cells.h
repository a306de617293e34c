#pragma once

// Positions of the elements of a job on a substrate, and the face of the blank before cutting.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/elements/part_spec.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::fabrication {

/// Returns the specification of the part that consists of the job's elements on the job's substrate.
/// \pre the job has a substrate
geometry::PartSpec part_on_substrate(const Job& job);

/// Returns the elements of a job on its substrate, in the workpiece frame. Only elements that are completely inside the
/// part in plan are included. They are sorted by rows with ascending y, and by x in each row (docs/theory/cutting.md).
/// \pre the job has a substrate, is a mould, and has lengths > 0
std::vector<CutElement> elements_on_substrate(const Job& job);

/// Returns the maximum height, in mm, of the blank's face above the plane of an element's rims (upper edges), inside
/// the opening of the element's cut. It is 0 on a flat blank, on an inclined blank with elements along its normal, and
/// on a convex blank.
/// \param clearance_mm distance from the blank's face that the tool must keep at the start of a cut. A tool at the
///        height result + clearance_mm above the rims keeps this distance
/// \throw InputError, whose text begins with "must", if the substrate is too steep for the tool to leave the cut
double stock_mm(const Job& job, const std::vector<CutElement>& elements, double clearance_mm = 0.0);

/// Returns a one-line description of the blank's face and of its zero point.
/// \pre the job has a substrate
std::string substrate_description(const Job& job);

/// Face of the blank before cutting: a plane, or the substrate of the job.
class BlankFace {
 public:
  explicit BlankFace(const Job& job);

  struct Projection {
    double height_mm = 0.0;
    geometry::Vec3 normal = geometry::Vec3::UnitZ();
  };
  /// Returns the normal of the face next to a point of the workpiece frame, and the height of the point above the face.
  /// The height is negative inside the blank. Outside of the part, the face is continued along its tangent.
  Projection projection_of(const geometry::Vec3& p) const;
  double height_mm(const geometry::Vec3& p) const { return projection_of(p).height_mm; }
  geometry::Vec3 normal_at(const geometry::Vec3& p) const { return projection_of(p).normal; }
  bool is_flat() const { return !surface_.has_value(); }

 private:
  geometry::Jet jet_at(const geometry::Vec3& p) const;

  std::optional<geometry::SubstrateSurface> surface_;
  geometry::Vec2 half_mm_ = geometry::Vec2::Zero();
  double scale_ = 1.0;
  double top_mm_ = 0.0;
};

}  // namespace retrace::fabrication
