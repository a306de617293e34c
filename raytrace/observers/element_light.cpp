#include "raytrace/observers/element_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/outline/convex_decomposition.h"
#include "raytrace/exact/flat_polygon.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/observers/photometric_geometry.h"

namespace retrace::raytrace {
namespace {

using geometry::ElementExcerpt, geometry::PartElement, geometry::Polygon;

// Maximum number of neighbours that bound the portion of an element. The nearest elements are used.
constexpr std::size_t kMaxNeighbours = 48;
// Maximum distance in plan between an element and the other cells of its excerpt, in element sizes.
constexpr double kSurroundings = 1.5;
// Half width of the square in which a polynomial is fitted to the surface, relative to the largest coordinate of the
// polygon from shadow_of().
constexpr double kFittedWidth = 1.25;
// Distance from the tangent point to the rays that concentration() compares, in element sizes.
constexpr double kConcentrationStep = 0.05;
// Area below which a polygon counts as empty, as a fraction of the squared element size.
constexpr double kEmptyArea = 1e-9;
// Distance below which corners are merged, in element sizes.
constexpr double kMerge = 1e-11;
// Size of the fragments into which the entrance face of an excerpt is divided, relative to its largest polygon. It
// exceeds 1, so that no polygon is divided.
constexpr double kFragment = 1.001;
// Minimum distance between an element and its tangent plane, in element sizes.
constexpr double kMinThickness = 1e-5;
// Maximum factor by which the curvature of the surface may increase or reduce the illuminance of an element.
constexpr double kMaxConcentration = 2.0;

/// Returns the intersection of a tangent plane with the half-space normal . p <= offset, which is given in the part
/// frame. The result is a half-plane in the frame of the tangent plane.
HalfPlane half_plane_on(const TangentPlane& plane, const Vec3& normal, double offset) {
  const Vec3 own = plane.frame_from_part * normal;
  return {own.x(), own.y(), offset - normal.dot(plane.point_mm)};
}

double largest_coordinate(const Polygon& polygon) {
  double most = 0.0;
  for (const Vec2& p : polygon) most = std::max(most, p.cwiseAbs().maxCoeff());
  return most;
}

Polygon as_polygon(const FlatPolygon& polygon) {
  return {polygon.begin(), polygon.end()};
}

/// Returns the projection of an element onto the tangent plane, along the light inside the part. If there were no other
/// elements, all light that enters through this polygon would meet the element first.
FlatPolygon shadow_of(const PartElement& element, const TangentPlane& plane, const Vec3& inside_direction) {
  const Vec3 own = plane.frame_from_part * inside_direction;
  std::vector<Vec2> points;
  for (const Vec3& corner : element.corners_mm) {
    const Vec3 at = plane.to_frame(corner);
    points.push_back((at - at.z() / own.z() * own).head<2>());
  }
  const Polygon hull = geometry::convex_hull(std::move(points));
  return {hull.begin(), hull.end()};
}

}  // namespace

struct ElementLight::Bounds {
  std::vector<HalfPlane> of_part;
  std::vector<HalfPlane> of_neighbours;
  double merge_mm = 0.0;
  double diameter_mm = 0.0;

  static void cut(FlatPolygon& polygon, const std::vector<HalfPlane>& halves, double merge_mm) {
    for (const HalfPlane& half : halves)
      if (!polygon.empty()) clip(polygon, half, merge_mm);
  }
  /// Returns the illuminated portion of a polygon.
  FlatPolygon lit(FlatPolygon polygon) const {
    cut(polygon, of_part, merge_mm);
    return polygon;
  }
  FlatPolygon cell() const {
    FlatPolygon polygon = {Vec2(-diameter_mm, -diameter_mm), Vec2(diameter_mm, -diameter_mm),
                           Vec2(diameter_mm, diameter_mm), Vec2(-diameter_mm, diameter_mm)};
    cut(polygon, of_neighbours, merge_mm);
    return polygon;
  }
};

ElementLight::ElementLight(const geometry::Part& part, std::shared_ptr<const geometry::EntranceSurface> surface)
    : part_(part), surface_(std::move(surface)), elements_(geometry::part_elements(part)) {
  const geometry::EntranceRange range = geometry::entrance_range(surface_, part.outline);
  beam_plane_ = range.inclined_plane.value_or(geometry::TouchingPlane{range.highest_mm, Vec2::Zero()});
  area_mm2_ = geometry::area(part.outline);
  diameter_mm_ = geometry::bounding_box(part.outline).size().norm();
  std::vector<std::uint32_t> others(elements_.size());
  std::iota(others.begin(), others.end(), 0U);
  for (const PartElement& element : elements_) {
    const auto distance = [&](std::uint32_t k) {
      return (elements_[k].apex_mm - element.apex_mm).head<2>().squaredNorm();
    };
    const std::size_t count = std::min(others.size(), kMaxNeighbours + 1);
    std::partial_sort(
        others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end(),
        [&](std::uint32_t a, std::uint32_t b) { return std::pair(distance(a), a) < std::pair(distance(b), b); });
    std::vector<std::uint32_t>& near = neighbours_.emplace_back();
    for (std::size_t k = 0; k < count; ++k)
      if (&elements_[others[k]] != &element) near.push_back(others[k]);
  }
}

std::optional<TangentPlane> ElementLight::plane_of(std::size_t element, const Vec3& to_source, double index) const {
  const Vec3& apex = elements_[element].apex_mm;
  const std::optional<Vec2> entry = point_of_entry(*surface_, apex, to_source, index);
  std::optional<TangentPlane> plane = tangent_plane(*surface_, entry.value_or(apex.head<2>()));
  if (plane && !(plane->normal.dot(to_source) > 0.0)) return std::nullopt;
  return plane;
}

ElementLight::Bounds ElementLight::bounds_of(const TangentPlane& plane, const Vec3& to_source,
                                             const std::vector<std::optional<Vec2>>& tangent_points) const {
  Bounds bounds;
  bounds.merge_mm = kMerge * part_.size_mm;
  bounds.diameter_mm = diameter_mm_;
  // Light that reaches a point below the plane of the incident beam has crossed this plane at a different position in
  // plan. The displacement in plan is `per_height` times the height of the plane above the point.
  const Vec2 per_height = to_source.head<2>() / rise_above(beam_plane_, to_source);
  for (std::size_t k = 0; k < part_.outline.size(); ++k) {
    const Vec2& a = part_.outline[k];
    const Vec2 along = part_.outline[(k + 1) % part_.outline.size()] - a;
    const Vec2 outward(along.y(), -along.x());
    bounds.of_part.push_back(half_plane_on(plane, {outward.x(), outward.y(), 0.0}, outward.dot(a)));
    // In the plane that touches the surface from above, the incident beam covers exactly the outline.
    const double lean = outward.dot(per_height);
    const Vec2 in_plane = outward + lean * beam_plane_.slope;
    bounds.of_part.push_back(
        half_plane_on(plane, {in_plane.x(), in_plane.y(), -lean}, outward.dot(a) - lean * beam_plane_.height_mm));
  }
  const Vec2 own = plane.point_mm.head<2>();
  for (const std::optional<Vec2>& other : tangent_points) {
    if (!other) continue;
    const Vec2 away = *other - own;
    if (away.norm() > bounds.merge_mm)
      bounds.of_neighbours.push_back(
          half_plane_on(plane, {away.x(), away.y(), 0.0}, away.dot(own) + 0.5 * away.squaredNorm()));
  }
  return bounds;
}

/// Returns the fraction of the light incident on the part that falls on 1 mm^2 of a tangent plane.
double ElementLight::fraction_per_mm2(const TangentPlane& plane, const Vec3& to_source) const {
  return plane.normal.dot(to_source) / (area_mm2_ * rise_above(beam_plane_, to_source));
}

std::vector<ElementPortion> ElementLight::portions(const Vec3& to_source, double index) const {
  std::vector<std::optional<TangentPlane>> planes;
  for (std::size_t k = 0; k < elements_.size(); ++k) planes.push_back(plane_of(k, to_source, index));
  std::vector<ElementPortion> portions(elements_.size());
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    const std::optional<TangentPlane>& plane = planes[k];
    if (!plane) continue;
    std::vector<std::optional<Vec2>> near;
    for (const std::uint32_t other : neighbours_[k])
      near.push_back(planes[other] ? std::optional(Vec2(planes[other]->point_mm.head<2>())) : std::nullopt);
    const Bounds bounds = bounds_of(*plane, to_source, near);
    const FlatPolygon cell = bounds.cell();
    const FlatPolygon lit = bounds.lit(cell);
    ElementPortion& portion = portions[k];
    portion.at_mm = plane->point_mm.head<2>();
    portion.fraction = lit.size() < 3 ? 0.0 : raytrace::area(lit) * fraction_per_mm2(*plane, to_source);
    const double beside_mm = 0.6 * (elements_[k].upper_mm - elements_[k].lower_mm).head<2>().maxCoeff();
    portion.is_at_border = lit.size() < 3 || raytrace::area(lit) < (1.0 - kEmptyArea) * raytrace::area(cell) ||
                           !geometry::contains(part_.outline, elements_[k].apex_mm.head<2>(), -beside_mm);
  }
  return portions;
}

std::unique_ptr<const ElementScene> ElementLight::scene(std::size_t element, const Vec3& to_source,
                                                        double index) const {
  const PartElement& own = elements_[element];
  const std::optional<TangentPlane> plane = plane_of(element, to_source, index);
  if (!plane) return nullptr;
  auto scene = std::make_unique<ElementScene>();
  scene->plane = *plane;
  double highest_mm = -INFINITY;
  for (const Vec3& corner : own.corners_mm) highest_mm = std::max(highest_mm, plane->to_frame(corner).z());
  const double thickness_mm = -highest_mm;
  if (!(thickness_mm > kMinThickness * part_.size_mm)) return nullptr;

  std::vector<std::optional<Vec2>> near;
  for (const std::uint32_t other : neighbours_[element]) {
    const std::optional<TangentPlane> of_other = plane_of(other, to_source, index);
    near.push_back(of_other ? std::optional(Vec2(of_other->point_mm.head<2>())) : std::nullopt);
  }
  const Bounds bounds = bounds_of(*plane, to_source, near);
  const double empty_mm2 = kEmptyArea * part_.size_mm * part_.size_mm;
  const FlatPolygon shadow = shadow_of(own, *plane, refracted_inside(plane->surface_slope, to_source, index));
  const FlatPolygon portion = bounds.lit(bounds.cell());
  const FlatPolygon lit_shadow = bounds.lit(shadow);
  FlatPolygons pieces;
  if (portion.size() >= 3 && raytrace::area(portion) > empty_mm2) {
    pieces.push_back(portion);
    if (lit_shadow.size() >= 3) subtract(lit_shadow, portion, empty_mm2, bounds.merge_mm, pieces);
  }
  if (pieces.empty()) {
    scene->is_lit = false;
    return scene;
  }

  Eigen::Isometry3d frame_from_part = Eigen::Isometry3d::Identity();
  frame_from_part.linear() = plane->frame_from_part;
  frame_from_part.translation() = Vec3(0.0, 0.0, thickness_mm) - plane->frame_from_part * plane->point_mm;
  scene->excerpt = geometry::excerpt_around(part_, own, frame_from_part, thickness_mm, kSurroundings * part_.size_mm);
  geometry::Part& made = scene->excerpt.part;
  double face_mm2 = 0.0;
  Vec2 largest_mm = Vec2::Zero();
  geometry::Rectangle box = geometry::bounding_box(made.outline);
  for (const FlatPolygon& piece : pieces) {
    made.entrance_pieces.push_back(as_polygon(piece));
    face_mm2 += raytrace::area(piece);
    largest_mm = largest_mm.cwiseMax(geometry::bounding_box(made.entrance_pieces.back()).size());
    for (const Vec2& p : piece) {
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
  }
  made.outline = geometry::to_polygon(box);
  // The exact engine divides the entrance face into fragments of the size of an element. This element is so large that
  // every polygon of the entrance face remains a single fragment.
  made.spec = {};
  made.spec.element = geometry::RtpElement{kFragment * largest_mm.x(), kFragment * largest_mm.y(), 90.0};
  made.entrance_area_mm2 = face_mm2;
  scene->portion_mm = as_polygon(portion);
  scene->fraction = raytrace::area(portion) * fraction_per_mm2(*plane, to_source);
  scene->to_source = scene->direction(to_source);
  const std::optional<double> denser =
      concentration(*surface_, *plane, to_source, index, own.upper_mm.z(), kConcentrationStep * part_.size_mm);
  const std::optional<SurfaceSag> sag =
      fitted_sag(*surface_, *plane, kFittedWidth * largest_coordinate(as_polygon(shadow)));
  if (!denser || *denser > kMaxConcentration || *denser < 1.0 / kMaxConcentration || !sag) return nullptr;
  scene->sag = *sag;
  const Vec3 inside = scene->direction(refracted_inside(plane->surface_slope, to_source, index));
  scene->squared_slope = squared_slope(*sag, inside.head<2>() / inside.z());
  scene->power_factor = *denser * face_mm2 * fraction_per_mm2(*plane, to_source);
  return scene;
}

Illumination illumination_of(const ElementScene& scene, const Vec3& to_source, const Stokes& stokes) {
  const SourceAngles angles = source_angles(scene.to_source);
  Illumination light{angles.incidence, angles.azimuth, stokes};
  // Rotation of the axes of polarization from the part frame to the frame of the excerpt.
  const Vec3 before = scene.direction(source_axis(to_source));
  const Vec3 after = source_axis(scene.to_source);
  const double c = after.dot(before);
  const double s = after.dot(scene.to_source.cross(before));
  light.stokes.q = (c * c - s * s) * stokes.q + 2.0 * c * s * stokes.u;
  light.stokes.u = (c * c - s * s) * stokes.u - 2.0 * c * s * stokes.q;
  return light;
}

namespace {

/// Returns a hit that describes the phase shift of the curved surface, for light that enters or leaves through the
/// tangent plane.
TexturedHit surface_hit(const ElementScene& scene, const ReturnedBeam& beam, double cos_outside) {
  TexturedHit hit;
  const double thickness_mm = scene.excerpt.part.thickness_mm;
  const double sine2 = (1.0 - cos_outside * cos_outside) / (beam.index * beam.index);
  hit.plane = {Vec3::UnitZ(), thickness_mm};
  hit.constant_mm = {0.0, 0.0, thickness_mm};
  hit.slope.setZero();
  hit.slope.topLeftCorner<2, 2>().setIdentity();
  hit.frame.origin_mm = {-beam.centre_mm.x(), -beam.centre_mm.y(), thickness_mm};
  hit.path_per_height = beam.index * std::sqrt(1.0 - sine2) - cos_outside;
  hit.form = &scene.sag.form;
  return hit;
}

/// Adds hits that describe the curvature of the entrance surface to a beam.
void add_surface(const ElementScene& scene, ReturnedBeam& beam) {
  // The frame of a facet's form has a horizontal and a downward axis. These directions refer to the part frame, not to
  // the frame of the excerpt.
  for (TexturedHit& hit : beam.hits) {
    if (hit.path_per_height == 0.0) continue;
    const Vec3 normal = scene.plane.frame_from_part.transpose() * hit.plane.normal;
    const Vec3 horizontal = normal.cross(Vec3::UnitZ()).normalized();
    hit.frame.horizontal = scene.plane.frame_from_part * horizontal;
    hit.frame.down = scene.plane.frame_from_part * normal.cross(horizontal);
  }
  TexturedHit entry = surface_hit(scene, beam, scene.to_source.z());
  entry.constant_mm.head<2>() = beam.entry_from_exit.translation();
  entry.slope.topLeftCorner<2, 2>() = beam.entry_from_exit.linear();
  beam.hits.push_back(entry);
  beam.hits.push_back(surface_hit(scene, beam, beam.direction.z()));
  // The surface makes the wave converge or diverge inside the part. If the optical path varies as phi(x) across the
  // wave, it varies as phi - L |grad phi|^2 / (2 n) after the length L (eikonal equation).
  const Vec2 exit = geometry::centroid(beam.exit_polygon_mm) - beam.centre_mm;
  const double path_mm =
      beam.phase_mm + beam.direction.head<2>().dot(exit) + scene.to_source.head<2>().dot(beam.entry_from_exit * exit);
  TexturedHit propagation = entry;
  propagation.form = &scene.squared_slope;
  propagation.path_per_height =
      -0.5 * path_mm / (beam.index * beam.index) * entry.path_per_height * entry.path_per_height;
  beam.hits.push_back(propagation);
}

}  // namespace

BeamResult trace_element(const ElementScene& scene, const Optics& optics, const Illumination& illumination,
                         const std::vector<double>& cones_deg, BeamPolicy policy, const Cancellation* cancel,
                         const BeamObserver& observer) {
  const ElementExcerpt& excerpt = scene.excerpt;
  policy.ends_at_sides = true;
  Optics own_optics = optics;
  for (Shell& shell : own_optics.shells)
    for (ShellSurface* const surface : {&shell.outer, &shell.inner}) surface->normal = scene.direction(surface->normal);
  const BeamTracer tracer(excerpt.part);
  return tracer.trace(own_optics, illumination, cones_deg, policy, cancel, [&](const ReturnedBeam& beam) {
    if (beam.depth == 0) return;
    const std::uint64_t first = beam.trail.first ? beam.trail.first->id : 0;
    const bool meets_element = beam.trail.first && excerpt.is_element[first];
    const bool is_own =
        meets_element ? first == 0 : geometry::contains(scene.portion_mm, geometry::centroid(beam.entry_polygon_mm));
    if (!is_own) return;
    ReturnedBeam curved = beam;
    add_surface(scene, curved);
    observer(curved);
  });
}

std::vector<DirectionSample> spread_directions(const ReturnedBeam& beam) {
  const auto bent = [&](const Vec2& exit_mm) {
    Vec2 cosines = beam.direction.head<2>();
    for (const TexturedHit& hit : beam.hits) {
      if (hit.form == nullptr) continue;
      const Vec3 at = hit.constant_mm + hit.slope.leftCols<2>() * (exit_mm - beam.centre_mm);
      cosines +=
          hit.path_per_height * hit.slope.topLeftCorner<2, 2>().transpose() * hit.form->slope(hit.frame.local(at));
    }
    return Vec3(cosines.x(), cosines.y(), std::sqrt(std::max(0.0, 1.0 - cosines.squaredNorm())));
  };
  std::vector<DirectionSample> samples;
  const Polygon& exit = beam.exit_polygon_mm;
  if (exit.size() < 3) return samples;
  const Vec2 middle = geometry::centroid(exit);
  const double whole = geometry::area(exit);
  for (std::size_t k = 0; k < exit.size(); ++k) {
    const Polygon corners = {middle, exit[k], exit[(k + 1) % exit.size()]};
    const double third = geometry::area(corners) / (3.0 * whole);
    for (std::size_t c = 0; c < 3; ++c)
      samples.push_back({bent(0.5 * corners[c] + (corners[0] + corners[1] + corners[2]) / 6.0), third});
  }
  return samples;
}

}  // namespace retrace::raytrace
