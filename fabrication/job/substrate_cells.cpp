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
#include "geometry/part/substrate_part.h"

namespace retrace::fabrication {
namespace {

using geometry::Polygon;
using geometry::Rectangle;
using geometry::SubstrateFrame;
using geometry::SubstrateSurface;
using geometry::Vec2;
using geometry::Vec3;

/// Outlines that cross the border by less than this share of the part's size lie within it, as in a design.
constexpr double kInsideTolerance = 1e-9;
/// Directions that differ by less than this are one: far below what rotary words tell apart.
constexpr double kSameDirection = 1e-13;

/// From axes of the part to those of the workpiece.
Vec3 in_workpiece(const Vec3& v) {
  return {v.y(), -v.x(), v.z()};
}

/// A corner of an element's aperture, from its middle or from over its apex, and how high it lies over the rims' plane.
struct RimCorner {
  Vec2 at_mm = Vec2::Zero();
  double height_mm = 0.0;
};

std::vector<RimCorner> rim_of(const geometry::Element& element) {
  const geometry::Cell cell = geometry::element_cell(element);
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(element);
  const double depth_mm = geometry::element_depth_mm(element);
  const Vec2 middle = is_prism ? Vec2(0.5 * geometry::bounding_box(cell.outline).upper) : Vec2(Vec2::Zero());
  std::vector<RimCorner> rim;
  for (const Vec2& p : cell.outline) {
    double height_mm = -depth_mm;
    for (const geometry::CellFacet& facet : cell.facets) height_mm = std::max(height_mm, facet.plane.at(p));
    // Rims of full cubes are not level.
    rim.push_back({p - middle, std::abs(height_mm) < 1e-12 * depth_mm ? 0.0 : height_mm});
  }
  return rim;
}

/// The arc coordinates that the part covers, as a box round their middle.
Rectangle arcs_of(const SubstrateSurface& surface, const Vec2& half_mm) {
  constexpr int kSteps = 128;
  Rectangle box{surface.arc_of(-half_mm), surface.arc_of(-half_mm)};
  for (int k = 0; k <= kSteps; ++k) {
    const double along = 2.0 * k / kSteps - 1.0;
    for (const double side : {-1.0, 1.0})
      for (const Vec2& p : {Vec2(along, side), Vec2(side, along)}) {
        const Vec2 arc = surface.arc_of(half_mm.cwiseProduct(p));
        box.lower = box.lower.cwiseMin(arc);
        box.upper = box.upper.cwiseMax(arc);
      }
  }
  return box;
}

class Placer {
 public:
  explicit Placer(const Job& job)
      : job_(job),
        spec_(part_on_substrate(job)),
        half_mm_(0.5 * Vec2(spec_.array.x_length_mm, spec_.array.y_length_mm)),
        surface_(geometry::substrate_surface_of(spec_)),
        top_mm_(geometry::measure_substrate(surface_, half_mm_).highest_mm),
        rim_(rim_of(job.element)) {}

  std::vector<CutElement> run() {
    std::vector<CutElement> placed;
    for (CutElement& element : on_sheet())
      if (place(element)) placed.push_back(element);
    if (!std::holds_alternative<geometry::RtpElement>(job_.element)) number(placed);
    return placed;
  }

 private:
  /// The elements of a flat array that is as large as the substrate is, rolled out.
  std::vector<CutElement> on_sheet() {
    Job sheet = job_;
    sheet.substrate.reset();
    if (std::holds_alternative<geometry::RtpElement>(job_.element)) {
      const Rectangle reach = surface_.arc_reach();
      sheet.array.x_length_mm = reach.size().x();
      sheet.array.y_length_mm = reach.size().y();
      middle_ = 0.5 * (reach.lower + reach.upper);
      return cut_elements(sheet);
    }
    // Apexes stand over the middle of the part; the tiling is laid out both ways as far as the longer one.
    const Rectangle reach = arcs_of(surface_, half_mm_);
    const Vec2 half = reach.lower.cwiseAbs().cwiseMax(reach.upper.cwiseAbs());
    const Vec2 room = surface_.is_upright() ? Vec2(Vec2::Zero()) : Vec2(Vec2::Constant(1e-6 * half.maxCoeff()));
    sheet.array.x_length_mm = 2.0 * (half.x() + room.x());
    sheet.array.y_length_mm = 2.0 * (half.y() + room.y());
    return cut_elements(sheet);
  }

  /// \return whether the element lies wholly within the part
  bool place(CutElement& element) {
    const double scale = blank_scale(job_.workpiece);
    const Vec2 on_sheet_mm = element.centre_mm / scale;
    const Vec2 arc = middle_ + Vec2(-on_sheet_mm.y(), on_sheet_mm.x());
    const SubstrateFrame frame = surface_.frame_at(arc);
    // Corners lie no further away in plan than on the sheet, but for how rows draw together.
    const double room_mm = 2.0 * geometry::width_across_mm(job_.element);
    const bool is_inside = ((frame.origin.head<2>().cwiseAbs().array() + room_mm) < half_mm_.array()).all();
    if (!is_inside && !is_within(arc, element.rotated)) return false;
    element.foot_mm = scale * in_workpiece(frame.origin - top_mm_ * Vec3::UnitZ());
    // Along x of the workpiece a flat array has y of the part, along y it has -x.
    element.turn.col(0) = in_workpiece(frame.along_v);
    element.turn.col(1) = -in_workpiece(frame.along_u);
    element.turn.col(2) = in_workpiece(frame.normal);
    element.orientation = orientation_of(element.turn);
    return true;
  }

  bool is_within(const Vec2& arc, bool rotated) const {
    const double tolerance_mm = kInsideTolerance * 2.0 * half_mm_.maxCoeff();
    const double side = rotated ? -1.0 : 1.0;  // prisms that are rotated are square
    return std::all_of(rim_.begin(), rim_.end(), [&](const RimCorner& corner) {
      Vec2 plan = surface_.plan_of(arc + side * corner.at_mm);
      if (corner.height_mm != 0.0 && !surface_.is_upright())
        plan += corner.height_mm * surface_.normal_at(plan).head<2>();
      return (plan.cwiseAbs().array() <= (half_mm_ + Vec2::Constant(tolerance_mm)).array()).all();
    });
  }

  std::int32_t orientation_of(const Eigen::Matrix3d& turn) {
    std::array<std::int64_t, 9> key{};
    for (Eigen::Index k = 0; k < 9; ++k)
      key[static_cast<std::size_t>(k)] = std::llround(turn(k / 3, k % 3) / kSameDirection);
    return known_.try_emplace(key, static_cast<std::int32_t>(known_.size())).first->second;
  }

  /// Rows without elements do not count, and cells count from the first that is cut.
  static void number(std::vector<CutElement>& elements) {
    std::int32_t row = -1;
    std::int32_t column = 0;
    std::int32_t before = 0;
    for (CutElement& element : elements) {
      if (row < 0 || element.row != before) {
        before = element.row;
        ++row;
        column = 0;
      }
      element.row = row;
      element.column = column++;
    }
  }

  const Job& job_;
  geometry::PartSpec spec_;
  Vec2 half_mm_;
  SubstrateSurface surface_;
  double top_mm_;
  std::vector<RimCorner> rim_;
  Vec2 middle_ = Vec2::Zero();
  std::map<std::array<std::int64_t, 9>, std::int32_t> known_;
};

/// Directions from an element's axis to the outline of what its cut opens at the blank's face, in its own frame, told
/// for an opening of depth 1 mm over the root or apex. Along the root a prism's opening does not grow.
struct Opening {
  std::vector<Vec2> grows;  ///< per mm over the root
  std::vector<Vec2> stays;  ///< added to it, in mm
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
  // Dihedral edges go out by sqrt(2) for each mm up.
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
  return Placer(job).run();
}

double stock_mm(const Job& job, const std::vector<CutElement>& elements, double clearance_mm) {
  if (!job.substrate) return 0.0;
  const BlankFace face(job);
  const geometry::Element element = blank_element(job);
  const std::array<Opening, 2> openings = {opening_of(element, false), opening_of(element, true)};
  constexpr int kMostRounds = 60;
  constexpr double kMostDepths = 3.0;
  constexpr double kSettledMm = 1e-8;
  double stock = 0.0;
  for (const CutElement& cut : elements) {
    const Opening& opening = openings[cut.rotated ? 1 : 0];
    // The higher the face, the wider the cut opens, and the higher the blank may stand over its border.
    for (int round = 0; round < kMostRounds; ++round) {
      double highest = stock;
      for (std::size_t k = 0; k < opening.grows.size(); ++k) {
        const Vec2 at = (opening.depth_mm + stock + clearance_mm) * opening.grows[k] + opening.stays[k];
        const Vec3 p = cut.foot_mm + cut.turn * Vec3(at.x(), at.y(), 0.0);
        // How far up the element's axis the face lies over that place.
        const BlankFace::Place under = face.under(p);
        const double rise = std::max(under.normal.dot(cut.turn.col(2)), 0.05);
        highest = std::max(highest, (clearance_mm - under.height_mm) / rise - clearance_mm);
      }
      const double more = highest - stock;
      stock = highest;
      if (stock > kMostDepths * opening.depth_mm || round + 1 == kMostRounds)
        throw InputError(
            fmt::format("must rise less over its elements for a tool to come out of its cuts: beside the element at "
                        "x = {}, y = {} mm of the blank it stands more than {} depths over the rims",
                        fixed(cut.foot_mm.x(), 4), fixed(cut.foot_mm.y(), 4), shortest(kMostDepths)));
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

BlankFace::Place BlankFace::under(const Vec3& p) const {
  if (!surface_) return {p.z(), Vec3::UnitZ()};
  const geometry::Jet jet = jet_at(p);
  const Vec3 normal = in_workpiece(Vec3(-jet.x, -jet.y, 1.0).normalized());
  return {(p.z() - scale_ * (jet.value - top_mm_)) * normal.z(), normal};
}

}  // namespace retrace::fabrication
