#pragma once

// The study behind `retrace fabricate`: plans a job and tells the tool path through one element.

#include <filesystem>
#include <string>
#include <vector>

#include "core/file_texts.h"
#include "core/warning.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::studies {

struct FabricationRequest {
  std::filesystem::path job_file;
  std::string dialect = "rs274ngc";
  FileTexts texts = {};  ///< of files that are given in place of being read
  fabrication::PlanOptions options;
};

/// A job as a plan and its programs in one dialect.
struct FabricationResult {
  fabrication::Job job;
  fabrication::Machine machine;
  fabrication::Plan plan;
  std::string dialect;
  std::string file_ending;  ///< of programs, with the dot
  Warnings warnings;

  std::string program_file(std::size_t k) const { return plan.programs[k].name + file_ending; }
};

/// Reads and plans a job. \throw InputError
FabricationResult fabricate(const FabricationRequest& request);

/// The way of the tool through one element. Of a prism in the section across its root: u to the side of facet 2, z up,
/// in mm from the root. Of a cube corner in the plane of facet 1: u along its level line towards its second dihedral
/// edge, z up its slope, in mm from the apex.
struct SectionMove {
  fabrication::Motion motion = fabrication::Motion::translate;
  double from_u_mm = 0.0;
  double from_z_mm = 0.0;
  double to_u_mm = 0.0;
  double to_z_mm = 0.0;
};

/// All cutting moves of the first element that is cut, those of roughing stages or of the others; of a cube corner
/// those on facet 1.
std::vector<SectionMove> section_moves(const FabricationResult& result, bool roughing);

/// For each element that is cut its place in the order of cutting, from 1, within the first stage of its orientation.
std::vector<std::int64_t> cutting_places(const FabricationResult& result);

}  // namespace retrace::studies
