#include "design/design_part.h"

#include "core/atomic_file.h"
#include "core/named_file.h"
#include "design/mask_part.h"
#include "geometry/io/facet_planes_reader.h"

namespace retrace::design {

geometry::Part part_of(const Design& design) {
  require_supported(design, {.what = {}, .solids = true, .entrances = true, .shells = true, .wet_backs = true});
  if (design.mask() && design.facet_planes())
    throw InputError(design.where("array.mask"), "not allowed together with facets in [part]");
  if (design.mask()) return geometry::build_part(design.part(), elements_of_mask(design));
  if (!design.facet_planes()) return geometry::build_part(design.part());
  if (const auto& planes = design.facet_planes()->planes) return geometry::build_part(design.part(), *planes);
  const std::string file = design.facet_planes()->file.string();
  return read_named(design.where("part.facets"), [&] {
    const geometry::FacetPlanes planes =
        geometry::parse_facet_planes(read_file(file, geometry::kMaxFacetPlanesBytes), file, design.part());
    return read_named({file, 0, ""}, [&] { return geometry::build_part(design.part(), planes); });
  });
}

Design single_element_of(const Design& design) {
  Design single = design;
  geometry::PartSpec spec = design.part();
  spec.array = {};
  spec.array.arrangement = geometry::Arrangement::single;
  spec.substrate.reset();
  spec.is_pin_bundle = false;
  single.shape = ElementArray{std::move(spec), {}, {}};
  return single;
}

}  // namespace retrace::design
