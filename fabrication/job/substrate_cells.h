#pragma once

// Jobs on a substrate: where their elements stand, and the face of the blank before it is cut.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/elements/part_spec.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::fabrication {

/// What a design would say of the job's part. \pre job.substrate
geometry::PartSpec part_on_substrate(const Job& job);

/// The elements of the job where they stand on its substrate, in the frame of the blank: those that lie wholly within
/// the part in plan, row by row from least y, x rising (docs/theory/cutting.md). \pre job.substrate, a mould, lengths
/// of the part > 0
std::vector<CutElement> elements_on_substrate(const Job& job);

/// By how much the blank stands over the plane of an element's rims at most, anywhere over what its cut opens; 0 on a
/// flat blank, on an inclined one with elements along its normal, and on one that bulges.
/// \param clearance_mm above 0: how much higher a tool starts that keeps that distance from the blank
/// \throw InputError, whose text begins with "must", if the substrate rises so steeply that no cut comes out of it
double stock_mm(const Job& job, const std::vector<CutElement>& elements, double clearance_mm = 0.0);

/// One line for people: what the blank's face is like, and where its zero is. \pre job.substrate
std::string substrate_description(const Job& job);

/// The face of the blank before anything is cut: its plane, or the job's substrate.
class BlankFace {
 public:
  explicit BlankFace(const Job& job);

  struct Place {
    double height_mm = 0.0;
    geometry::Vec3 normal = geometry::Vec3::UnitZ();
  };
  /// The face over or under a point of the workpiece frame: its normal there, and how far the point lies off it along
  /// that; negative: within the blank. Beyond the part's border the face goes on straight.
  Place under(const geometry::Vec3& p) const;
  double height_mm(const geometry::Vec3& p) const { return under(p).height_mm; }
  geometry::Vec3 normal_at(const geometry::Vec3& p) const { return under(p).normal; }
  bool is_flat() const { return !surface_.has_value(); }

 private:
  geometry::Jet jet_at(const geometry::Vec3& p) const;

  std::optional<geometry::SubstrateSurface> surface_;
  geometry::Vec2 half_mm_ = geometry::Vec2::Zero();
  double scale_ = 1.0;
  double top_mm_ = 0.0;
};

}  // namespace retrace::fabrication
