#pragma once

// Reads the files of flat lenses that are planed or turned (retrace.planed_part/1).

#include <filesystem>
#include <string>
#include <string_view>

#include "core/schema/schema.h"
#include "fabrication/planing/part.h"

namespace retrace::fabrication {

/// Returns the schema of part files (retrace.planed_part/1). They contain parts that are planed or turned.
const schema::Format& planed_part_format();

/// Reads a part that is planed or turned (`retrace.planed_part/1`, docs/planing_file.md).
/// \throw InputError naming file, line and key
PlanedPart parse_planed_part(std::string_view text, const std::string& source_name);
PlanedPart read_planed_part(const std::filesystem::path& file);

}  // namespace retrace::fabrication
