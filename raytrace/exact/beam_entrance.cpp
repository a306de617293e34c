#include "raytrace/exact/beam_entrance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "raytrace/exact/beam_reach.h"
#include "raytrace/exact/lit_face.h"

namespace retrace::raytrace {
namespace {

// Number of facets of an element above which the light on the element is divided into several fragments. Each fragment
// then meets about this number of facets.
constexpr double kFacetsOfPiece = 30.0;

/// An interval of the entrance face along one axis, and the displacements to its copies, in mm.
struct Span {
  double from = 0.0;
  double to = 0.0;
  std::vector<double> shifts;
};

/// Divides a side of the entrance face into intervals, with `steps` intervals per period. All intervals whose distance
/// is a multiple of the period form one Span. The last interval of the side may be shorter and is then a Span of its
/// own.
std::vector<Span> spans(double lower, double upper, double period, int steps) {
  std::vector<Span> all;
  const double step = period / steps;
  const double near = 1e-9 * step;
  for (int k = 0; k < steps; ++k) {
    const double from = lower + k * step;
    Span whole{from, from + step, {}};
    for (std::int64_t i = 0;; ++i) {
      const double shift = static_cast<double>(i) * period;
      if (from + shift + step <= upper + near) {
        whole.shifts.push_back(shift);
        continue;
      }
      if (from + shift < upper - near) all.push_back({from + shift, upper, {0.0}});
      break;
    }
    if (!whole.shifts.empty()) all.push_back(std::move(whole));
  }
  return all;
}

/// Returns the portion of a polygon between two values of the coordinate along an axis.
Corners between(const Corners& corners, const Vec3& axis, double from, double to) {
  return cut(cut(corners, {axis, from}), {-axis, -to});
}

/// Returns the bounding box of a beam's cross-section in x and y.
PlanBox plan_of(const Beam& beam) {
  PlanBox box;
  for (const Vec3& p : beam.corners) box.include(p.head<2>());
  return box;
}

/// Returns the number of parts, along either axis, into which the light on an element is divided. The work of finding
/// hidden facets grows as the square of the number of facets, and elements with rounded edges have dozens of facets.
double parts_of_element(const geometry::Part& part) {
  double facets = 0.0;
  for (const geometry::SurfacePatch& patch : part.patches)
    facets = std::max(facets, static_cast<double>(patch.facets.size()) / static_cast<double>(patch.cells.size()));
  return std::max(1.0, std::ceil(std::sqrt(facets / kFacetsOfPiece)));
}

/// Returns the maximum size in x and y of fragments of the incident beam. A fragment covers at most one element. It
/// therefore meets few facets.
/// \param parts number of fragments per element along either axis
Vec2 step_of_entrance(const geometry::Part& part, double parts) {
  Vec2 step = Vec2::Constant(part.size_mm);
  if (const auto* rtp = std::get_if<geometry::RtpElement>(&part.spec.element))
    step = Vec2(rtp->base_mm + part.spec.array.x_gap_mm, rtp->width_mm + part.spec.array.y_gap_mm);
  return step / parts;
}

/// The incident beam and the fragments into which it is divided.
class Division {
 public:
  Division(const BeamScene& scene, const Beam& whole, BeamQueue& queue)
      : merge_mm_(scene.merge_mm), whole_(whole), queue_(queue), whole_area_(area_of(whole.corners)) {}

  const Beam& whole() const { return whole_; }
  /// Queues a fragment.
  /// \param places displacements to its copies (Beam::instance_offsets); empty for the displacements of the whole beam
  /// \param region parts with zones: index in TranslationalSymmetry::regions()
  void add(Corners corners, InstanceOffsets places = {}, std::uint32_t region = 0) {
    if (corners.empty()) return;
    Beam piece = whole_;
    piece.corners = std::move(corners);
    piece.area_fraction = whole_.area_fraction * (area_of(piece.corners) / whole_area_);
    if (piece.area_fraction <= 0.0) return;
    if (!places.empty()) piece.instance_offsets = queue_.shared(std::move(places));
    piece.region = region;
    entered_ += piece.area_fraction * (piece.instance_count() / whole_.instance_count());
    queue_.push(std::move(piece));
  }
  /// Returns the sum of Beam::area_fraction over all queued fragments and their copies, divided by the number of copies
  /// of the whole beam.
  double entered() const { return entered_; }

 private:
  double area_of(const Corners& corners) const { return area(flattened(corners, Frame(-Vec3::UnitZ()), merge_mm_)); }

  double merge_mm_;
  const Beam& whole_;
  BeamQueue& queue_;
  double whole_area_;
  double entered_ = 0.0;
};

/// Divides a beam into fragments of the size `step`.
void divide_by_step(const Vec2& step, Division& into) {
  const PlanBox box = plan_of(into.whole());
  for (double y = box.lower.y(); y < box.upper.y() - 1e-9 * step.y(); y += step.y()) {
    const Corners row = between(into.whole().corners, Vec3::UnitY(), y, y + step.y());
    for (double x = box.lower.x(); x < box.upper.x() - 1e-9 * step.x(); x += step.x())
      into.add(between(row, Vec3::UnitX(), x, x + step.x()));
  }
}

/// Divides a beam into fragments. Each fragment also represents its copies, which are displaced by multiples of the
/// period.
/// \param most_step maximum size of a fragment
/// \pre the entrance face is a rectangle with sides along the x and y axes
void divide_by_period(const Vec2& period, const Vec2& most_step, Division& into) {
  const PlanBox box = plan_of(into.whole());
  const Vec2 steps = period.cwiseQuotient(most_step).array().round().max(1.0);
  const auto along = [&](Eigen::Index axis) {
    return spans(box.lower[axis], box.upper[axis], period[axis], static_cast<int>(steps[axis]));
  };
  for (const Span& y : along(1)) {
    const Corners row = between(into.whole().corners, Vec3::UnitY(), y.from, y.to);
    for (const Span& x : along(0)) {
      InstanceOffsets places;
      for (const double up : y.shifts)
        for (const double right : x.shifts) places.emplace_back(right, up);
      into.add(between(row, Vec3::UnitX(), x.from, x.to), std::move(places));
    }
  }
}

/// Divides the portion of a beam that is above one region of a part with zones (areas with different arrays).
void divide_region(const PeriodicRegion& region, std::uint32_t number, const Vec2& most_step, Division& into) {
  const auto add = [&](const geometry::Polygon& tile, InstanceOffsets places) {
    into.add(cut_to_outline(cut_to_outline(into.whole().corners, tile), region.outline_mm()), std::move(places),
             number);
  };
  for (const PeriodicRegion::Tiles& tiles : region.tiles(most_step)) {
    if (!tiles.inner.empty()) add(tiles.first, tiles.inner);
    for (const geometry::Polygon& tile : tiles.at_border) add(tile, {});
  }
}

/// Returns the outline of the entrance face, or the central period of an infinite part.
geometry::Polygon entrance_outline(const geometry::Part& part) {
  if (part.period_mm) return geometry::to_polygon({Vec2::Zero(), *part.period_mm});
  return part.outline;
}

/// Returns the beam that enters a convex portion of the entrance face.
Beam incident_beam(const BeamScene& scene, const geometry::Polygon& portion) {
  const LightSetup& setup = scene.setup;
  Beam whole;
  whole.direction = setup.entry.direction;
  whole.light = setup.entry.light;
  // The incident wave has phase 0 at the centre of the entrance face. Beam::phase_mm is extrapolated from there to the
  // origin.
  whole.phase_mm = -setup.optics.index * setup.entry.direction.z() * setup.thickness_mm;
  whole.start = {-Vec3::UnitZ(), -setup.thickness_mm};
  whole.path_length = PathLength{}.continued(whole.start, whole.direction, 1.0);
  whole.entry.constant_mm = scene.centre_mm;
  whole.entry.slope.leftCols<2>().setIdentity();
  whole.entry = whole.entry.continued(whole.start, whole.direction);
  for (const auto& p : portion)
    whole.corners.push_back({p.x() - scene.centre_mm.x(), p.y() - scene.centre_mm.y(), setup.thickness_mm});
  return whole;
}

/// Reduces the beam on one period of an infinite part to one half if the two halves of the period are identical.
void keep_half(const TranslationalSymmetry& equal, Beam& whole, BeamQueue& queue) {
  const auto& by = equal.within_period_mm();
  if (!by) return;
  const Eigen::Index axis = by->y() > 0.0 ? 1 : 0;
  const double middle = plan_of(whole).lower[axis] + 0.5 * equal.period_mm()[axis];
  whole.corners = cut(whole.corners, {-Vec3::Unit(axis), -middle});
  whole.area_fraction = 0.5;
  whole.instance_offsets = queue.shared({Vec2::Zero(), *by});
}

/// Divides the incident beam into fragments according to the symmetry of the part. Returns the sum of
/// Division::entered() over all regions of the part.
double divide(const BeamScene& scene, const Beam& whole, const Vec2& most_step, BeamQueue& queue) {
  if (scene.symmetry == nullptr || scene.setup.infinite() || scene.symmetry->regions().empty()) {
    Division into(scene, whole, queue);
    if (scene.symmetry == nullptr || scene.setup.infinite())
      divide_by_step(most_step, into);
    else
      divide_by_period(scene.symmetry->period_mm(), most_step, into);
    return into.entered();
  }
  double entered = 0.0;
  for (std::uint32_t number = 0; number < scene.symmetry->regions().size(); ++number) {
    Division into(scene, whole, queue);
    divide_region(scene.symmetry->regions()[number], number, most_step, into);
    entered += into.entered();
  }
  return entered;
}

/// Divides the incident beam of a part with notches or holes into fragments. The symmetry of such a part has one region
/// for each polygon of the entrance face, in the same order. Returns the fraction of the light that has entered.
double divide_pieces(const BeamScene& scene, const Vec2& most_step, BeamQueue& queue) {
  double face_mm2 = 0.0;
  for (const geometry::Polygon& piece : scene.part.entrance_pieces) face_mm2 += geometry::area(piece);
  double entered = 0.0;
  for (std::size_t k = 0; k < scene.part.entrance_pieces.size(); ++k) {
    const geometry::Polygon& piece = scene.part.entrance_pieces[k];
    Beam whole = incident_beam(scene, piece);
    whole.area_fraction = geometry::area(piece) / face_mm2;
    Division into(scene, whole, queue);
    if (scene.symmetry != nullptr && !scene.symmetry->regions().empty())
      divide_region(scene.symmetry->regions()[k], static_cast<std::uint32_t>(k), most_step, into);
    else
      divide_by_step(most_step, into);
    entered += into.entered();
  }
  return entered;
}

}  // namespace

void enter_beams(const BeamScene& scene, BeamRecord& record, BeamQueue& queue) {
  Beam whole = incident_beam(scene, entrance_outline(scene.part));
  if (!scene.setup.stops.is_empty()) {
    LitFace lit(scene);
    if (lit.reached.empty()) return;
    whole.corners = std::move(lit.reached);
    whole.area_fraction = lit.reached_fraction;
  }
  const double parts = parts_of_element(scene.part);
  if (scene.setup.infinite()) {
    if (scene.symmetry != nullptr) keep_half(*scene.symmetry, whole, queue);
    if (parts == 1.0) return queue.push(std::move(whole));
  }
  const Vec2 most_step = step_of_entrance(scene.part, parts);
  const double entered = scene.part.entrance_pieces.empty() ? divide(scene, whole, most_step, queue)
                                                            : divide_pieces(scene, most_step, queue);
  record.add_rounding_loss(whole, whole.area_fraction - entered);
}

}  // namespace retrace::raytrace
