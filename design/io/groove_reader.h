#pragma once

// Reads and writes the table [grooves] of designs with ruled cells, and checks such designs.

#include "core/schema/document.h"
#include "geometry/elements/part_spec.h"

namespace retrace::design {

/// Returns the ruled cells that a document describes.
/// \pre element.kind is "ruled"
/// \throw InputError if the table [grooves] is missing or incomplete, or if the grooves leave no cells
geometry::RuledCells read_grooves(const schema::Document& document);

/// Writes the groove sets, in the form `custom`.
void set_grooves(schema::Document& document, const geometry::RuledCells& ruled);

// Rules of the design format.
void check_grooves(const schema::Document& document);
void check_ruled_part(const schema::Document& document, const geometry::PartSpec& part);

}  // namespace retrace::design
