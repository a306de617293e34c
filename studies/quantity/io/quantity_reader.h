#pragma once

// Reads the quantities of a study file.

#include <filesystem>
#include <vector>

#include "core/schema/document.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// One [[quantity]] of a study, which may stand for several, such as every point of a standard.
/// \param at path of its table \param files the files that it names are added \throw InputError
Quantities read_quantity(const schema::Document& document, const std::string& at,
                         std::vector<std::filesystem::path>& files);

}  // namespace retrace::studies
