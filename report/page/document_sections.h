#pragma once

// Functions that make the sections of the page, one for each kind of result document. This header is private to the
// page. Functions for documents about light come first.

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report::document {

using SectionOf = PageSection(const ResultDocument& document, const ResultFolder& folder);

SectionOf rre_section, footprint_section, far_field_section;
SectionOf inspect_section, image_section, photometry_section, roughness_section, fabrication_section;
SectionOf verification_section, forces_section, sweep_section, optimum_section;
/// Makes the section of documents without a specific section. It contains their values, and tables of their lists.
SectionOf plain_section;

}  // namespace retrace::report::document
