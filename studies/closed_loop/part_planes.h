#pragma once

// The part that is moulded in a blank whose facets lie in planes of their own, wherever these planes come from.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/edge_cut.h"
#include "geometry/elements/facet_planes.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// What the part is made of: that of the job's design, or what is taken without one.
struct MachinedBody {
  double thickness_mm = 2.0;
  std::string material = "PMMA";
  std::optional<GlassCatalogueFile> catalogue;
  std::optional<double> refractive_index;
  std::optional<double> temperature_c;
  Absorption absorption_per_mm;

  Substance substance() const;
};

/// The design that a job was made from, if it lies beside the job's file.
std::optional<Design> design_beside(const fabrication::Job& job, const std::filesystem::path& job_file);

/// As that design says. \param warnings is told where it is missed
MachinedBody machined_body(const fabrication::Job& job, const std::filesystem::path& job_file, Warnings& warnings);

/// The elements of the job, all alike, or with a table of planes.
geometry::PartSpec machined_elements(const fabrication::Job& job, bool has_planes);

/// The planes of the facets of an element as it was cut, in the workpiece frame, in the order of its groove; none: it
/// is not cut.
using ElementCutPlanes = std::vector<fabrication::CutPlane>;

/// What they are in the part that is moulded in the blank. \param elements as cut_elements() has them
/// \pre a mould; an element is cut
geometry::FacetPlanes part_planes(const fabrication::Job& job, const std::vector<ElementCutPlanes>& elements);

}  // namespace retrace::studies
