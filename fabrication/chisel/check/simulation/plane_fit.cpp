#include "fabrication/chisel/check/simulation/plane_fit.h"

#include "core/length_units.h"

namespace retrace::fabrication {

using geometry::Vec3;

void PlaneFit::fit(FacetFigures& figures) const {
  if (points_.empty()) return;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points_) mean += p;
  mean /= static_cast<double>(points_.size());
  double uu = 0.0, uv = 0.0, vv = 0.0, ut = 0.0, vt = 0.0;
  for (const Vec3& p : points_) {
    const Vec3 d = p - mean;
    uu += d.x() * d.x();
    uv += d.x() * d.y();
    vv += d.y() * d.y();
    ut += d.x() * d.z();
    vt += d.y() * d.z();
  }
  figures.mean_nm = mean.z() * kNmPerMm;
  figures.mean_up_mm = mean.x();
  figures.mean_along_mm = mean.y();
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-12 * uu * vv)) return;
  figures.slope_up = (ut * vv - vt * uv) / determinant;
  figures.slope_along = (vt * uu - ut * uv) / determinant;
}

}  // namespace retrace::fabrication
