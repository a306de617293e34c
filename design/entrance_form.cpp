#include "design/entrance_form.h"

#include <limits>
#include <optional>
#include <utility>

#include "core/named_file.h"
#include "geometry/direction.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/io/substrate_rows.h"
#include "geometry/surface/step_surface.h"

namespace retrace::design {

using geometry::Vec2, geometry::Vec3;

namespace {

/// Returns the size of the smallest features of a shape, or infinity if it is unknown. At an edge between two faces,
/// the curvature is infinite, and a search for the size would not end.
double finest_mm(const geometry::EntranceShape& shape) {
  constexpr double kFeaturesAcross = 16.0;
  const auto* const face = std::get_if<geometry::StepFace>(&shape);
  if (face == nullptr || face->surface->patches.face_count() == 1) return std::numeric_limits<double>::infinity();
  return face->surface->size_mm.maxCoeff() / kFeaturesAcross;
}

}  // namespace

std::shared_ptr<const geometry::EntranceSurface> surface_of(const EntranceForm& form, const Vec3& origin_mm) {
  const geometry::SurfacePose pose{origin_mm,
                                   geometry::rotation_of(form.inclination) *
                                       geometry::rotation_about(Vec3::UnitZ(), Angle::from_deg(form.rotation_deg))};
  return std::make_shared<const geometry::EntranceSurface>(
      geometry::FreeformSurface(geometry::height_of(form.shape), std::nullopt, {}, {}), pose, finest_mm(form.shape));
}

void find_offset(Design& design) {
  if (!design.elements() || !design.part().substrate) return;
  geometry::PartSpec& part = design.part();
  auto* const offset = std::get_if<geometry::OffsetSubstrate>(&part.substrate->shape);
  if (offset == nullptr) return;
  const Vec2 half_mm = 0.5 * Vec2(part.array.x_length_mm, part.array.y_length_mm);
  const std::optional<std::array<double, 2>>& given = design.entrance->centre_mm;
  const Vec2 centre_mm = given ? Vec2((*given)[0], (*given)[1]) - half_mm : Vec2(Vec2::Zero());
  const auto surface = surface_of(*design.entrance->form(), {centre_mm.x(), centre_mm.y(), 0.0});
  read_named(design.where(design.entrance_key()), [&] {
    // Error messages need positions in the part frame. The position of the substrate is relative to the centre of the
    // part.
    const Vec2 middle_mm = centre_mm + half_mm;
    geometry::check_folds(*surface_of(*design.entrance->form(), {middle_mm.x(), middle_mm.y(), 0.0}),
                          geometry::to_polygon({Vec2::Zero(), 2.0 * half_mm}));
  });
  offset->entrance_mm = [surface](const Vec2& position_mm) { return surface->at(position_mm).height_mm; };
  const geometry::SubstrateMeasures measures = read_named(design.where(geometry::substrate_shape_key(*part.substrate)),
                                                          [&] { return geometry::check_substrate(part); });
  part.thickness_mm = measures.highest_mm - measures.lowest_mm + offset->wall_mm;
}

}  // namespace retrace::design
