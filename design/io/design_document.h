#pragma once

// Writes designs as documents and files; the inverse of design_reader.h.

#include "core/schema/document.h"
#include "design/design.h"

namespace retrace::design {

/// Returns a design as a document with all keys including defaults, but without its source.
schema::Document document_of(const Design& design);

/// Returns the text of a design file without unnecessary keys.
/// \param comment text of the comment lines at its beginning
std::string design_text(const Design& design, const std::string& comment = {});

}  // namespace retrace::design
