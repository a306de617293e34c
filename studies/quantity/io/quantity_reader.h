#pragma once

#include <filesystem>
#include <vector>

#include "core/toml_file.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// One [[quantity]] of a study, which may stand for several, such as every point of a standard.
/// \param files the files that it names are added \throw InputError
Quantities read_quantity(TomlTable quantity, std::vector<std::filesystem::path>& files);

}  // namespace retrace::studies
