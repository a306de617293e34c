#pragma once

// Study of the command `retrace fabricate`: plans a job, and computes the tool path through one element.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "requests/job.h"

namespace retrace::studies {

/// Planned job, with its programs in one dialect.
struct FabricationResult {
  fabrication::Job job;
  fabrication::Machine machine;
  fabrication::Plan plan;
  std::string dialect;
  std::string file_ending;  ///< file extension of the programs, with the dot
  Warnings warnings;

  std::string program_file(std::size_t k) const { return plan.programs[k].name + file_ending; }
};

/// Reads a fabrication job and plans its cuts.
/// \param job job file. Relative file names in the job refer to the folder of the job file.
/// \throw InputError for an invalid job or request
FabricationResult fabricate(const std::filesystem::path& job, const FabricationRequest& request = {});

/// Move of the tool in one element, in a section. For a prism, the section is across the root: u points to the side of
/// facet 2 and z up, measured from the root. For a cube corner, the section is the plane of facet 1: u points along the
/// horizontal line of the facet, towards the facet's second dihedral edge, and z up the facet, measured from the apex.
struct SectionMove {
  fabrication::Motion motion = fabrication::Motion::translate;
  double from_u_mm = 0.0;
  double from_z_mm = 0.0;
  double to_u_mm = 0.0;
  double to_z_mm = 0.0;
};

/// Returns all cutting moves of the first element. For a cube corner, returns only the moves on facet 1.
/// \param roughing true: moves of roughing stages (steps of machining); false: moves of all other stages
std::vector<SectionMove> section_moves(const FabricationResult& result, bool roughing);

/// Returns, for each element, its number in the order of cutting, counted from 1. If several programs cut an element,
/// the first one counts.
std::vector<std::int64_t> cutting_order_numbers(const FabricationResult& result);

}  // namespace retrace::studies
