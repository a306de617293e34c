#pragma once

// A part with four prisms, and simulated measurements of this part. The verifier computes the facets for a machine with
// errors. The tested functions do not receive these errors.

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/verify.h"
#include "studies/calibration/correction.h"
#include "tests/support/prism_jobs.h"

namespace retrace::test {

/// Returns a plan for four prisms with flat gaps of 0.25 mm between them.
inline const studies::FabricationResult& four_prisms() {
  static const studies::FabricationResult made = planned(prism_job({90.0, 0.25, 10.0, 1}));
  return made;
}

/// Returns the grooves of a job that cuts prisms.
inline std::vector<fabrication::PrismGroove> prism_grooves(const fabrication::Job& job) {
  std::vector<fabrication::PrismGroove> grooves;
  for (const fabrication::Cavity& groove : fabrication::designed_cavities(job))
    grooves.push_back(std::get<fabrication::PrismGroove>(groove));
  return grooves;
}

/// Machined surface of a part, as a height z(x, y) in the workpiece frame: the facet planes that the verifier computes,
/// and the face of the blank at z = 0.
class CutSurface {
 public:
  explicit CutSurface(const fabrication::Machine& real, const studies::FabricationResult& made = four_prisms())
      : grooves_(prism_grooves(made.job)), figures_(cut_on(real, made)) {
    for (std::size_t element = 0; element < grooves_.size(); ++element)
      for (std::size_t facet = 0; facet < 2; ++facet) {
        const fabrication::FacetFigures& f = figures_[2 * element + facet];
        const fabrication::DesignFacet& design = grooves_[element].facets[facet];
        const geometry::Vec3& along = design.along;
        const geometry::Vec3 point = grooves_[element].root_mm + f.mean_up_mm * design.up_slope +
                                     f.mean_along_mm * along + 1e-6 * f.mean_nm * design.normal;
        const geometry::Vec3 normal =
            (design.normal - f.slope_up * design.up_slope - f.slope_along * along).normalized();
        planes_.emplace_back(normal, point);
      }
  }

  double z(double x, double y) const {
    const geometry::Vec3 p(x, y, 0.0);
    for (std::size_t element = 0; element < grooves_.size(); ++element) {
      const fabrication::PrismGroove& groove = grooves_[element];
      const double along = groove.along_mm(p);
      const double across =
          groove.root_direction.x() * (y - groove.root_mm.y()) - groove.root_direction.y() * (x - groove.root_mm.x());
      if (std::abs(along) > groove.half_width_mm || std::abs(across) > groove.half_base_mm) continue;
      double z = -1e9;
      for (const auto& [normal, point] : {planes_[2 * element], planes_[2 * element + 1]})
        z = std::max(z, point.z() - (normal.x() * (x - point.x()) + normal.y() * (y - point.y())) / normal.z());
      return std::min(z, 0.0);
    }
    return 0.0;
  }

  /// Returns the maximum deviations of the facets from the design. A common rotation or displacement of the whole part
  /// is removed first, because it cannot be observed.
  studies::DeviationPrediction off() const {
    constexpr double kTiltNm = 250.0;  // converts a rotation to the deviation over half a facet
    const auto facets = static_cast<Eigen::Index>(planes_.size());
    Eigen::MatrixXd of_pose(3 * facets, 5);
    Eigen::VectorXd off(3 * facets);
    for (Eigen::Index k = 0; k < facets; ++k) {
      const fabrication::FacetFigures& f = figures_[static_cast<std::size_t>(k)];
      const fabrication::PrismGroove& groove = grooves_[static_cast<std::size_t>(k / 2)];
      const fabrication::DesignFacet& design = groove.facets[static_cast<std::size_t>(k % 2)];
      const geometry::Vec3& along = design.along;
      const geometry::Vec3 at = groove.root_mm + f.mean_up_mm * design.up_slope + f.mean_along_mm * along;
      const geometry::Vec3& n = design.normal;
      of_pose.row(3 * k) << at.cross(n).transpose(), n.x(), n.y();
      of_pose.row(3 * k + 1) << kTiltNm * 1e-6 * design.up_slope.cross(n).transpose(), 0.0, 0.0;
      of_pose.row(3 * k + 2) << kTiltNm * 1e-6 * along.cross(n).transpose(), 0.0, 0.0;
      off.segment<3>(3 * k) << 1e-6 * f.mean_nm, kTiltNm * 1e-6 * f.slope_up, kTiltNm * 1e-6 * f.slope_along;
    }
    const Eigen::VectorXd left = off - of_pose * of_pose.colPivHouseholderQr().solve(off);
    studies::DeviationPrediction most;
    for (Eigen::Index k = 0; k < left.size(); ++k)
      if (k % 3 == 0)
        most.distance_nm = std::max(most.distance_nm, 1e6 * std::abs(left[k]));
      else
        most.tilt_arcsec = std::max(most.tilt_arcsec, kArcsecPerRad * 1e6 / kTiltNm * std::abs(left[k]));
    return most;
  }

  /// Returns the maximum error of the apex angles.
  double apex_error_arcsec() const {
    double most = 0.0;
    for (std::size_t k = 0; k < figures_.size(); k += 2)
      most = std::max(most, kArcsecPerRad * std::abs(figures_[k].slope_up + figures_[k + 1].slope_up));
    return most;
  }

  const std::vector<fabrication::PrismGroove>& grooves() const { return grooves_; }
  const fabrication::FacetFigures& figures(std::size_t element, std::size_t facet) const {
    return figures_[2 * element + facet];
  }

 private:
  static std::vector<fabrication::FacetFigures> cut_on(const fabrication::Machine& real,
                                                       const studies::FabricationResult& made) {
    const fabrication::Verification v = fabrication::verify_programs(made.job, real, programs_of(made), {}, {});
    std::vector<fabrication::FacetFigures> figures;
    for (const fabrication::ElementResult& element : v.elements)
      for (const fabrication::FacetFigures& facet : element.figures.facets) figures.push_back(facet);
    return figures;
  }

  std::vector<fabrication::PrismGroove> grooves_;
  std::vector<fabrication::FacetFigures> figures_;  ///< figures of all facets
  std::vector<std::pair<geometry::Vec3, geometry::Vec3>> planes_;
};

/// Position of a point of a facet relative to the edge that cut it: along the edge from the centre of the edge, and up
/// the facet from the root. While a facet is cut, it is vertical with its outward normal along -Y. The direction of the
/// edge, +X, is therefore the cross product of z and this normal.
struct UnderEdge {
  double along_mm = 0.0;
  double up_mm = 0.0;
};

/// Surface of a cut part with an additional pattern, in nm, that depends on the position under the edge.
template <class Pattern>
class PatternedSurface {
 public:
  PatternedSurface(const CutSurface& cut, Pattern pattern)
      : cut_(cut), grooves_(cut.grooves()), pattern_(std::move(pattern)) {}

  double z(double x, double y) const {
    const double plain = cut_.z(x, y);
    if (plain >= 0.0) return plain;
    const geometry::Vec3 p(x, y, plain);
    for (const fabrication::PrismGroove& groove : grooves_) {
      const geometry::Vec3 from_root = p - groove.root_mm;
      const geometry::Vec3 across = from_root - groove.root_direction * groove.root_direction.dot(from_root);
      if (std::abs(groove.along_mm(p)) > groove.half_width_mm || across.head<2>().norm() > groove.half_base_mm)
        continue;
      const fabrication::DesignFacet& facet =
          groove.facets[groove.facets[0].up_slope.dot(from_root) > groove.facets[1].up_slope.dot(from_root) ? 0 : 1];
      const geometry::Vec3 edge = geometry::Vec3::UnitZ().cross(facet.normal).normalized();
      const double nm = pattern_(UnderEdge{edge.dot(from_root), facet.up_slope.dot(from_root)});
      return plain + 1e-6 * nm / facet.normal.z();
    }
    return plain;
  }

 private:
  const CutSurface& cut_;
  std::vector<fabrication::PrismGroove> grooves_;
  Pattern pattern_;
};

/// Returns the value of a quantity of a facet that is measured on a part in a given pose.
/// \param figures values that the verifier computes for the facet, in the workpiece frame
inline double measured_of(const fabrication::Cavity& groove, const fabrication::FacetFigures& figures,
                          std::size_t facet, studies::FacetQuantity what, const fabrication::RigidMotion& pose) {
  const fabrication::DesignFacet& design = fabrication::common(groove).facets[facet];
  const geometry::Vec3& along = design.along;
  const geometry::Vec3 normal =
      pose.direction(design.normal - figures.slope_up * design.up_slope - figures.slope_along * along);
  const geometry::Vec3 point = pose.point(fabrication::common(groove).root_mm + figures.mean_up_mm * design.up_slope +
                                          figures.mean_along_mm * along + 1e-6 * figures.mean_nm * design.normal);
  switch (what) {
    case studies::FacetQuantity::tilt_up:
      return -kArcsecPerRad * normal.dot(design.up_slope) / normal.dot(design.normal);
    case studies::FacetQuantity::tilt_along: return -kArcsecPerRad * normal.dot(along) / normal.dot(design.normal);
    default: return 1e6 * normal.dot(point - fabrication::facet_centre(groove, facet)) / normal.dot(design.normal);
  }
}

/// Simulates a height map of the whole part in a random pose, with a noise of 5 nm (standard deviation). With 220
/// points per row, the points are 6 um apart.
template <class Surface>
studies::FacetMap seen(const Surface& surface, std::mt19937& bits, std::size_t points = 220) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::AngleAxisd turn(0.02 * uniform(bits), geometry::Vec3::UnitZ());
  const Eigen::AngleAxisd tip(0.003 * uniform(bits), geometry::Vec3(uniform(bits), uniform(bits), 0.0).normalized());
  const Eigen::Matrix3d part_from_map = (turn * tip).toRotationMatrix();
  const geometry::Vec3 shift(0.15 * uniform(bits), 0.15 * uniform(bits), 0.3 * uniform(bits));
  const double pixel_mm = 1.32 / static_cast<double>(points);
  studies::FacetMap map{"map.txt", {points, points, 1e3 * pixel_mm, 1e3 * pixel_mm, {}}, {0.0, 0.0}, 0.0};
  for (std::size_t row = 0; row < points; ++row)
    for (std::size_t column = 0; column < points; ++column) {
      const double x = pixel_mm * (static_cast<double>(column) - 0.5 * static_cast<double>(points - 1));
      const double y = pixel_mm * (static_cast<double>(row) - 0.5 * static_cast<double>(points - 1));
      // Iterate for the height at which the line of sight intersects the part. The tilt of the part is so small that
      // each step reduces the error to less than a hundredth of its value.
      constexpr int kSteps = 8;
      double z = -shift.z();
      for (int step = 0; step < kSteps; ++step) {
        const geometry::Vec3 p = part_from_map * geometry::Vec3(x, y, z) + shift;
        const double missing = surface.z(p.x(), p.y()) - p.z();
        z += missing;
        if (std::abs(missing) < 1e-10) break;
      }
      map.heights.heights_nm.push_back(1e6 * z + 5.0 * normal(bits));
    }
  return map;
}

}  // namespace retrace::test
