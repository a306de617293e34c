#include "studies/design/design_part.h"

#include "core/atomic_file.h"
#include "studies/design/facet_planes_reader.h"

namespace retrace::studies {

geometry::Part part_of(const Design& design) {
  if (!design.facet_planes) return geometry::build_part(design.part);
  const std::string file = design.facet_planes->file.string();
  const geometry::FacetPlanes planes = parse_facet_planes(read_file(design.facet_planes->file), file, design.part);
  try {
    return geometry::build_part(design.part, planes);
  } catch (const InputError& error) {
    throw InputError({file, 0, ""}, error.what());
  }
}

}  // namespace retrace::studies
