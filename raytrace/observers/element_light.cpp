#include "raytrace/observers/element_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/outline/convex_decomposition.h"
#include "raytrace/exact/excerpt_light.h"
#include "raytrace/exact/flat_polygon.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/observers/photometric_geometry.h"

namespace retrace::raytrace {
namespace {

using geometry::ElementExcerpt, geometry::PartElement, geometry::Polygon;

// Maximum number of neighbours that bound the portion of an element. The nearest elements are used.
constexpr std::size_t kMaxNeighbours = 48;
// An excerpt contains all cells within a certain distance from its element in plan. This distance is kSurroundings
// element sizes plus kReflectedReach times the depth of the element below the entrance face. It must be large, because
// total reflection at the entrance face can carry light far from the element. For a plane surface, light that leaves an
// excerpt of this size changes the returned power by less than 1e-4.
constexpr double kSurroundings = 3.0;
constexpr double kReflectedReach = 4.0;
// Half width of the square in which a polynomial is fitted to the surface, relative to the largest coordinate of the
// polygon from shadow_of().
constexpr double kFittedWidth = 1.25;
// Distance from the tangent point to the neighbouring rays of entry_displacement(), in element sizes.
constexpr double kRayDistance = 0.05;
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

/// Vertical side of the part.
struct Side {
  Vec2 on_mm = Vec2::Zero();  ///< any point of the side, in plan
  Vec2 outward = Vec2::UnitX();

  double excess(const Vec3& p) const { return outward.dot(p.head<2>() - on_mm); }
};

/// Returns the corners of an element after reflection in the plane of a side.
std::vector<Vec3> mirrored_at(const Side& side, std::vector<Vec3> corners_mm) {
  for (Vec3& p : corners_mm) p.head<2>() -= 2.0 * side.excess(p) * side.outward;
  return corners_mm;
}

/// Returns the corners of an element and of its mirror images at sides of the part. Light that a side reflects to the
/// element would travel straight to the mirror image if the side were absent. Mirror images at up to two sides are
/// included.
/// \param reach_mm maximum horizontal distance that light travels before it meets the element
std::vector<std::vector<Vec3>> images_of(const PartElement& element, const Polygon& outline, const Vec3& inside,
                                         double reach_mm) {
  std::vector<Side> sides;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 along = (outline[(k + 1) % outline.size()] - outline[k]).normalized();
    const Side side{outline[k], {along.y(), -along.x()}};
    double nearest_mm = INFINITY;
    for (const Vec3& corner : element.corners_mm) nearest_mm = std::min(nearest_mm, -side.excess(corner));
    if (nearest_mm < reach_mm) sides.push_back(side);
  }
  std::vector<std::vector<Vec3>> images = {element.corners_mm};
  for (const Side& first : sides) {
    const double towards = first.outward.dot(inside.head<2>());
    if (!(towards > 0.0)) continue;
    images.push_back(mirrored_at(first, element.corners_mm));
    const Vec2 reflected = inside.head<2>() - 2.0 * towards * first.outward;
    for (const Side& second : sides)
      if (second.outward.dot(reflected) > 0.0)
        images.push_back(mirrored_at(first, mirrored_at(second, element.corners_mm)));
  }
  return images;
}

/// Returns the mean height of the element's corners that form its outline when seen along the light. For a cube corner,
/// these corners form its rim.
double rim_height(const std::vector<Vec3>& corners_mm, const Vec3& inside) {
  const auto seen = [&](const Vec3& p) { return Vec2((p - p.z() / inside.z() * inside).head<2>()); };
  std::vector<Vec2> points;
  for (const Vec3& corner : corners_mm) points.push_back(seen(corner));
  double sum = 0.0;
  double count = 0.0;
  for (const Vec2& of_hull : geometry::convex_hull(std::move(points)))
    for (const Vec3& corner : corners_mm)
      if (seen(corner) == of_hull) {
        sum += corner.z();
        count += 1.0;
      }
  return sum / count;
}

/// Returns the convex hull of an element's corners, projected onto the tangent plane along the light inside the part.
/// If there were no other elements, all light that enters through this hull would meet the element first.
/// \param inside direction of the light in the frame of the tangent plane
Polygon shadow_of(const std::vector<Vec3>& corners_mm, const TangentPlane& plane, const Vec3& inside) {
  std::vector<Vec2> points;
  for (const Vec3& corner : corners_mm) {
    const Vec3 at = plane.to_frame(corner);
    points.push_back((at - at.z() / inside.z() * inside).head<2>());
  }
  return geometry::convex_hull(std::move(points));
}

/// Returns the excerpt around an element in the frame of its tangent plane. The given polygons form its entrance face.
geometry::ElementExcerpt excerpt_with_face(const geometry::Part& part, const PartElement& own,
                                           const TangentPlane& plane, double thickness_mm, const FlatPolygons& pieces) {
  Eigen::Isometry3d frame_from_part = Eigen::Isometry3d::Identity();
  frame_from_part.linear() = plane.frame_from_part;
  frame_from_part.translation() = Vec3(0.0, 0.0, thickness_mm) - plane.frame_from_part * plane.point_mm;
  const double height_mm = plane.point_mm.z() - own.lower_mm.z();
  geometry::ElementExcerpt excerpt = geometry::excerpt_around(
      part, own, frame_from_part, thickness_mm, kSurroundings * part.size_mm + kReflectedReach * height_mm);
  geometry::Part& made = excerpt.part;
  made.entrance_area_mm2 = 0.0;
  Vec2 largest_mm = Vec2::Zero();
  geometry::Rectangle box = geometry::bounding_box(made.outline);
  for (const FlatPolygon& piece : pieces) {
    made.entrance_pieces.push_back(as_polygon(piece));
    made.entrance_area_mm2 += raytrace::area(piece);
    largest_mm = largest_mm.cwiseMax(geometry::bounding_box(made.entrance_pieces.back()).size());
    for (const Vec2& p : piece) {
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
  }
  made.outline = geometry::to_polygon(box);
  // The exact engine divides the entrance face into fragments of the size of an element. The size that is set here is
  // so large that no polygon of the entrance face is divided.
  made.spec = {};
  made.spec.element = geometry::RtpElement{kFragment * largest_mm.x(), kFragment * largest_mm.y(), 90.0};
  return excerpt;
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
  /// Returns bounds for points e whose displaced points K e satisfy the present bounds.
  Bounds before(const Eigen::Matrix2d& displacement) const {
    Bounds changed = *this;
    for (std::vector<HalfPlane>* const halves : {&changed.of_part, &changed.of_neighbours})
      for (HalfPlane& half : *halves) {
        const Vec2 normal = displacement.transpose() * Vec2(half.a, half.b);
        half = {normal.x(), normal.y(), half.c};
      }
    return changed;
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
                                             const std::vector<Vec2>& tangent_points) const {
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
  for (const Vec2& other : tangent_points) {
    const Vec2 away = other - own;
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
    std::vector<Vec2> near;
    for (const std::uint32_t other : neighbours_[k])
      if (planes[other]) near.push_back(planes[other]->point_mm.head<2>());
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

  std::vector<Vec2> near;
  for (const std::uint32_t other : neighbours_[element])
    if (const std::optional<TangentPlane> of_other = plane_of(other, to_source, index))
      near.push_back(of_other->point_mm.head<2>());
  const double empty_mm2 = kEmptyArea * part_.size_mm * part_.size_mm;
  const Bounds bounds = bounds_of(*plane, to_source, near);
  const FlatPolygon lit_cell = bounds.lit(bounds.cell());
  scene->is_lit = lit_cell.size() >= 3 && raytrace::area(lit_cell) > empty_mm2;
  if (!scene->is_lit) return scene;
  const Vec3 direction = refracted_inside(plane->surface_slope, to_source, index);
  const Vec3 inside = scene->direction(direction);
  const double rim_mm = rim_height(own.corners_mm, direction);
  scene->rim_path_mm = (rim_mm - plane->point_mm.z()) / direction.z();
  const std::optional<Eigen::Matrix2d> displacement =
      entry_displacement(*surface_, *plane, to_source, index, rim_mm, kRayDistance * part_.size_mm);
  if (!displacement) return nullptr;
  const double denser = displacement->determinant();
  if (denser > kMaxConcentration || denser < 1.0 / kMaxConcentration) return nullptr;
  // For each ray that enters through the curved surface, the tracer needs the point at which it would enter the tangent
  // plane. For a convex surface, these points cover a smaller area.
  const Bounds model_bounds = bounds.before(*displacement);
  const FlatPolygon portion = model_bounds.lit(model_bounds.cell());
  scene->is_lit = portion.size() >= 3;
  if (!scene->is_lit) return scene;
  // Light that meets the element first enters through the shadow of the element or through the shadow of a mirror
  // image. Light that enters between these shadows meets other elements first and is not traced (ExcerptLight).
  const double height_mm = plane->point_mm.z() - own.lower_mm.z();
  const double reach_mm = height_mm * direction.head<2>().norm() / -direction.z();
  Polygon entries;
  for (const std::vector<Vec3>& image : images_of(own, part_.outline, direction, reach_mm)) {
    const Polygon shadow = shadow_of(image, *plane, inside);
    if (model_bounds.lit({shadow.begin(), shadow.end()}).size() >= 3)
      entries.insert(entries.end(), shadow.begin(), shadow.end());
  }
  FlatPolygons pieces = {portion};
  if (!entries.empty()) {
    entries = geometry::convex_hull(std::move(entries));
    const FlatPolygon lit_entries = model_bounds.lit({entries.begin(), entries.end()});
    if (lit_entries.size() >= 3) subtract(lit_entries, portion, empty_mm2, bounds.merge_mm, pieces);
  }

  scene->excerpt = excerpt_with_face(part_, own, *plane, thickness_mm, pieces);
  scene->portion_mm = as_polygon(portion);
  scene->fraction = raytrace::area(lit_cell) * fraction_per_mm2(*plane, to_source);
  scene->to_source = scene->direction(to_source);
  double extent_mm = largest_coordinate(entries);
  for (const FlatPolygon& piece : pieces) extent_mm = std::max(extent_mm, largest_coordinate(as_polygon(piece)));
  const std::optional<SurfaceSag> sag = fitted_sag(*surface_, *plane, kFittedWidth * extent_mm);
  if (!sag) return nullptr;
  scene->sag = *sag;
  scene->squared_slope = squared_slope(*sag, inside.head<2>() / inside.z());
  scene->power_factor = denser * scene->excerpt.part.entrance_area_mm2 * fraction_per_mm2(*plane, to_source);
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

/// Convergence or divergence of light behind a curved surface. phi is the optical path that the surface adds where
/// light enters. It is a function of the point x of the tangent plane at which this light leaves.
struct Convergence {
  Eigen::Matrix2d second;  ///< matrix of the second derivatives of phi
  Vec2 first;              ///< gradient of phi at the centre of the entrance face
  double path_mm = 0.0;    ///< path length inside the part of light that leaves at the tangent point
};

Convergence convergence_of(const ElementScene& scene, const ReturnedBeam& beam, const TexturedHit& entry) {
  Convergence of;
  const Eigen::Matrix2d slope = beam.entry_from_exit.linear();
  const Eigen::Matrix2d gradients = entry.path_per_height * slope.transpose() * scene.sag.curvature_per_mm();
  of.second = gradients * slope;
  of.first = gradients * (beam.entry_from_exit.translation() + beam.centre_mm);
  // The path is computed for a fixed point and not for the centre of the beam's polygon. The phases of all fragments of
  // a wave are therefore consistent.
  const Vec2 exit = -beam.centre_mm;
  of.path_mm = (beam.phase_mm + beam.direction.head<2>().dot(exit) +
                scene.to_source.head<2>().dot(beam.entry_from_exit * exit)) /
               beam.index;
  return of;
}

/// Displaces the exit polygon of a beam to the points at which the light behind the curved surface leaves. After a path
/// of length L, a ray is displaced by L grad phi / n, measured perpendicular to the light. The entry region already
/// includes the displacement up to the rim of the element. The remaining displacement changes the area of the polygon
/// at constant power. The amplitude is therefore multiplied by the square root of the old area divided by the new area.
void move_exit(const ElementScene& scene, const Convergence& convergence, ReturnedBeam& beam) {
  const double length_mm = convergence.path_mm - scene.rim_path_mm;
  const Vec2 across = beam.direction.head<2>() / beam.index;
  const Eigen::Matrix2d along_plane =
      Eigen::Matrix2d::Identity() + across * across.transpose() / (1.0 - across.squaredNorm());
  const Eigen::Matrix2d per_gradient = length_mm / beam.index * along_plane;
  for (Vec2& p : beam.exit_polygon_mm)
    p += per_gradient * (convergence.first + convergence.second * (p - beam.centre_mm));
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
  const Convergence convergence = convergence_of(scene, beam, entry);
  TexturedHit propagation = entry;
  propagation.form = &scene.squared_slope;
  propagation.path_per_height = -0.5 * convergence.path_mm / beam.index * entry.path_per_height * entry.path_per_height;
  beam.hits.push_back(propagation);
  move_exit(scene, convergence, beam);
}

}  // namespace

BeamResult trace_element(const ElementScene& scene, const Optics& optics, const Illumination& illumination,
                         const std::vector<double>& cones_deg, BeamPolicy policy, const Cancellation* cancel,
                         const BeamObserver& observer) {
  const ElementExcerpt& excerpt = scene.excerpt;
  const ExcerptLight selected{excerpt, scene.portion_mm};
  policy.excerpt = &selected;
  Optics own_optics = optics;
  for (Shell& shell : own_optics.shells)
    for (ShellSurface* const surface : {&shell.outer, &shell.inner}) surface->normal = scene.direction(surface->normal);
  const BeamTracer tracer(excerpt.part);
  return tracer.trace(own_optics, illumination, cones_deg, policy, cancel, [&](const ReturnedBeam& beam) {
    // Light that met no cell is ignored: only sides and the entrance face have reflected it.
    if (beam.depth == 0 || !beam.trail.first) return;
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
