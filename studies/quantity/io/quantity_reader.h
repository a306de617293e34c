#pragma once

// Reads the quantities of a study file.

#include <vector>

#include "core/schema/document.h"
#include "studies/design/io/design_reader.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// One [[quantity]] of a study, which may stand for several, such as every point of a standard.
/// \param at path of its table \param files the files that it names are added \throw InputError
Quantities read_quantity(const schema::Document& document, const std::string& at, std::vector<NamedFile>& files);

}  // namespace retrace::studies
