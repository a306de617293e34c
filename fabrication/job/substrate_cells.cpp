#include "fabrication/job/substrate_cells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/elements/whole_elements.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Maximum difference between the components of two directions that are considered equal. It is far below the
/// resolution of rotary positions in programs.
constexpr double kSameDirection = 1e-13;

/// Transforms a vector from the part frame to the workpiece frame.
Vec3 in_workpiece(const Vec3& v) {
  return {v.y(), -v.x(), v.z()};
}

/// Assigns numbers to the orientations of elements. Equal orientations have the same number.
class Orientations {
 public:
  std::int32_t number_of(const Eigen::Matrix3d& turn) {
    std::array<std::int64_t, 9> key{};
    for (Eigen::Index k = 0; k < 9; ++k)
      key[static_cast<std::size_t>(k)] = std::llround(turn(k / 3, k % 3) / kSameDirection);
    return known_.try_emplace(key, static_cast<std::int32_t>(known_.size())).first->second;
  }

 private:
  std::map<std::array<std::int64_t, 9>, std::int32_t> known_;
};

/// Outline of the opening of an element's cut in a plane above the root or apex, in the frame of the element. Its
/// points are height * grows[k] + stays[k]. The length of a prism's opening along the root is constant.
struct Opening {
  std::vector<Vec2> grows;  ///< part of the outline that is proportional to the height, per mm
  std::vector<Vec2> stays;  ///< constant part of the outline, in mm
  double depth_mm = 0.0;
};

Opening opening_of(const geometry::Element& element, bool rotated) {
  Opening opening;
  opening.depth_mm = geometry::element_depth_mm(element);
  if (const auto* const prism = std::get_if<geometry::RtpElement>(&element)) {
    const double slope = 0.5 * prism->base_mm / opening.depth_mm;
    for (const double across : {-1.0, -0.5, 0.0, 0.5, 1.0})
      for (const double along : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        const Vec2 grow(0.0, across * slope);
        const Vec2 stay(0.5 * along * prism->width_mm, 0.0);
        opening.grows.push_back(rotated ? Vec2(grow.y(), grow.x()) : grow);
        opening.stays.push_back(rotated ? Vec2(stay.y(), stay.x()) : stay);
      }
    return opening;
  }
  // In plan, a point of a dihedral edge moves outward by sqrt(2) mm per mm of height.
  constexpr double kDeg = std::numbers::pi / 180.0;
  std::array<Vec2, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const double azimuth = (120.0 * static_cast<double>(k) - 90.0 + (rotated ? 180.0 : 0.0)) * kDeg;
    corners[k] = std::numbers::sqrt2 * Vec2(std::cos(azimuth), std::sin(azimuth));
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (const double share : {0.0, 0.25, 0.5, 0.75})
      for (const double inwards : {1.0, 0.5}) {
        opening.grows.push_back(inwards * ((1.0 - share) * corners[k] + share * corners[(k + 1) % 3]));
        opening.stays.emplace_back(Vec2::Zero());
      }
  return opening;
}

}  // namespace

geometry::PartSpec part_on_substrate(const Job& job) {
  geometry::PartSpec spec;
  spec.element = job.element;
  spec.array = job.array;
  spec.array.partial_elements = geometry::PartialElements::omit;
  spec.substrate = job.substrate;
  return spec;
}

std::vector<CutElement> elements_on_substrate(const Job& job) {
  const double scale = blank_scale(job.workpiece);
  Orientations orientations;
  std::vector<CutElement> elements;
  for (const geometry::PlacedElement& at : geometry::place_elements(part_on_substrate(job))) {
    if (at.border_relation != geometry::BorderRelation::inside) continue;
    CutElement& element = elements.emplace_back();
    element.centre_mm = scale * Vec2(at.on_sheet.centre_mm.y(), -at.on_sheet.centre_mm.x());
    element.row = at.on_sheet.row;
    element.column = at.on_sheet.column;
    element.rotated = at.on_sheet.is_rotated;
    element.origin_mm = scale * in_workpiece(at.frame.origin);
    // x_w is y of the part, and y_w is -x of the part.
    element.workpiece_from_element.col(0) = in_workpiece(at.frame.along_v);
    element.workpiece_from_element.col(1) = -in_workpiece(at.frame.along_u);
    element.workpiece_from_element.col(2) = in_workpiece(at.frame.normal);
    element.orientation = orientations.number_of(element.workpiece_from_element);
  }
  return elements;
}

double stock_mm(const Job& job, const std::vector<CutElement>& elements, double clearance_mm) {
  if (!job.substrate) return 0.0;
  const BlankFace face(job);
  const geometry::Element element = blank_element(job);
  const std::array<Opening, 2> openings = {opening_of(element, false), opening_of(element, true)};
  constexpr int kMaxRounds = 60;
  constexpr double kMaxStockDepths = 3.0;
  constexpr double kSettledMm = 1e-8;
  double stock = 0.0;
  for (const CutElement& cut : elements) {
    const Opening& opening = openings[cut.rotated ? 1 : 0];
    // The higher the face, the wider the opening. At the border of a wider opening, the face may be higher still.
    // Iterate until the height is constant.
    for (int round = 0; round < kMaxRounds; ++round) {
      double highest = stock;
      for (std::size_t k = 0; k < opening.grows.size(); ++k) {
        const Vec2 at = (opening.depth_mm + stock + clearance_mm) * opening.grows[k] + opening.stays[k];
        const Vec3 p = cut.origin_mm + cut.workpiece_from_element * Vec3(at.x(), at.y(), 0.0);
        // Height of the blank's face above this point, along the axis of the element.
        const BlankFace::Projection under = face.projection_of(p);
        const double rise = std::max(under.normal.dot(cut.workpiece_from_element.col(2)), 0.05);
        highest = std::max(highest, (clearance_mm - under.height_mm) / rise - clearance_mm);
      }
      const double more = highest - stock;
      stock = highest;
      if (stock > kMaxStockDepths * opening.depth_mm || round + 1 == kMaxRounds)
        throw InputError(
            fmt::format("the substrate is too steep: next to the element at x = {}, y = {} mm of the blank, it is more "
                        "than {} element depths above the rims, so that the tool cannot move out of its cuts",
                        fixed(cut.origin_mm.x(), 4), fixed(cut.origin_mm.y(), 4), shortest(kMaxStockDepths)));
      if (more <= kSettledMm) break;
    }
  }
  return stock < 1e-9 ? 0.0 : stock;
}

namespace {

struct ShapeWords {
  std::string operator()(const geometry::PlaneSubstrate& plane) const {
    return fmt::format("a plane that rises by {} deg towards {} deg from x of the part", shortest(plane.incline_deg),
                       shortest(plane.azimuth_deg));
  }
  std::string operator()(const geometry::CylinderSubstrate& cylinder) const {
    return fmt::format("a cylinder of radius {} mm along {} of the part", shortest(cylinder.radius_mm),
                       cylinder.axis_is_x ? "x" : "y");
  }
  std::string operator()(const geometry::SphereSubstrate& sphere) const {
    return fmt::format("a sphere of radius {} mm", shortest(sphere.radius_mm));
  }
  std::string operator()(const geometry::FormulaSubstrate&) const { return "the job's formula"; }
  std::string operator()(const geometry::OffsetSubstrate&) const { return "a surface below the entrance surface"; }
  std::string operator()(const geometry::StepFace&) const { return "a face of a STEP file"; }
};

}  // namespace

std::string substrate_description(const Job& job) {
  return "Face of the blank: " + std::visit(ShapeWords{}, job.substrate->shape) +
         (job.substrate->element_axes == geometry::ElementAxes::normal ? ", elements along its normal"
                                                                       : ", elements in parallel") +
         ". Z0 is its highest place, X0 Y0 its middle";
}

BlankFace::BlankFace(const Job& job) {
  if (!job.substrate) return;
  const geometry::PartSpec spec = part_on_substrate(job);
  half_mm_ = 0.5 * Vec2(spec.array.x_length_mm, spec.array.y_length_mm);
  scale_ = blank_scale(job.workpiece);
  surface_.emplace(geometry::substrate_surface_of(spec));
  top_mm_ = geometry::measure_substrate(*surface_, half_mm_).highest_mm;
}

geometry::Jet BlankFace::jet_at(const Vec3& p) const {
  const Vec2 plan = Vec2(-p.y(), p.x()) / scale_;
  const Vec2 within = plan.cwiseMax(-half_mm_).cwiseMin(half_mm_);
  geometry::Jet jet = surface_->at(within);
  jet.value += Vec2(jet.x, jet.y).dot(plan - within);
  return jet;
}

BlankFace::Projection BlankFace::projection_of(const Vec3& p) const {
  if (!surface_) return {p.z(), Vec3::UnitZ()};
  const geometry::Jet jet = jet_at(p);
  const Vec3 normal = in_workpiece(Vec3(-jet.x, -jet.y, 1.0).normalized());
  return {(p.z() - scale_ * (jet.value - top_mm_)) * normal.z(), normal};
}

}  // namespace retrace::fabrication
