#include "studies/compose/io/zone_designs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "core/number_format.h"
#include "studies/design/io/design_document.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::studies {

std::size_t most_zone_designs(const ComposeRequest& request) {
  return std::min<std::size_t>(100, request.most_zones.value_or(100));
}

std::string zone_design_text(const Study& study, const PartOfZones& part, std::size_t zone) {
  const Candidate candidate = make_candidate(study, part.zones[zone].cell.values);
  std::string comment =
      fmt::format("# Zone {} of {} of {}: {} of the area", zone + 1, part.zones.size(),
                  std::filesystem::path(study.source).filename().string(), shortest(part.zones[zone].share));
  if (const double turn_deg = candidate.analysis().rotation_deg; turn_deg != 0.0)
    comment += fmt::format(", turned by {} degrees (--rotation of retrace photometry)", shortest(turn_deg));
  return design_text(candidate.design(), comment + "\n");
}

}  // namespace retrace::studies
