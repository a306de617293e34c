#pragma once

// Reads the quantities of a study file.

#include <vector>

#include "core/schema/document.h"
#include "design/io/design_reader.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// Reads a table [[quantity]] of a study. One table may describe several quantities, such as one for each test point of
/// a standard.
/// \param at path of the table
/// \param files receives the files that the table names
/// \throw InputError for invalid keys
Quantities read_quantity(const schema::Document& document, const std::string& at,
                         std::vector<design::NamedFile>& files);

}  // namespace retrace::studies
