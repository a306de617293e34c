#pragma once

// Computes the part that is moulded from a machined blank. Each facet of the blank has its own plane, which follows
// from the cuts.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/edge_cut.h"
#include "geometry/elements/facet_planes.h"

namespace retrace::studies {

/// Thickness and material of the part: from the design of the job, or default values without a design.
struct MachinedBody {
  double thickness_mm = 2.0;
  std::string material = "PMMA";
  std::optional<design::GlassCatalogueFile> catalogue;
  std::optional<double> refractive_index;
  std::optional<double> temperature_c;
  design::Absorption absorption_per_mm;

  design::Substance substance() const;
};

/// Returns the design from which a job was made, or nothing if the file does not exist in the folder of the job.
std::optional<design::Design> design_of_job(const fabrication::Job& job, const std::filesystem::path& job_file);

/// Returns thickness and material of the job's design, or default values.
/// \param warnings receives a warning if the design does not exist
MachinedBody machined_body(const fabrication::Job& job, const std::filesystem::path& job_file, Warnings& warnings);

/// Returns the keys of the outline of the job's part, which are taken from the job's design. Returns no keys if there
/// is no design or if the outline of the design differs from that of the job.
/// \throw InputError at the field `as_machined` if there are no keys and the job has a hole that is not round. A design
///     can describe such a hole only by a DXF file.
/// \pre the job has an outline
design::OutlineKeys outline_of_job(const fabrication::Job& job, const std::filesystem::path& job_file);

/// Returns the specification of the elements of a job. Elements that the outline would cut are omitted.
/// \param has_planes true: each facet has its own plane; false: all elements are equal
geometry::PartSpec machined_elements(const fabrication::Job& job, bool has_planes);

/// Planes of the facets of an element as cut, in the workpiece frame, in the order of the facets of its groove. Empty
/// if the element is not cut.
using ElementCutPlanes = std::vector<fabrication::CutPlane>;

/// Transforms the planes of cut facets to planes of the moulded part.
/// \param elements planes of each element, in the order of cut_elements()
/// \pre the job is a mould, and at least one element is cut
geometry::FacetPlanes part_planes(const fabrication::Job& job, const std::vector<ElementCutPlanes>& elements);

}  // namespace retrace::studies
