#pragma once

// Writes designs as documents and files: the way back from design_reader.h.

#include "core/schema/document.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// A design as a document that says all of it, defaults too; but for its source.
schema::Document document_of(const Design& design);

/// The text of a design file that says no more than is needed. \param comment what it is, on lines of its own
std::string design_text(const Design& design, const std::string& comment = {});

}  // namespace retrace::studies
