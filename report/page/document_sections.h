#pragma once

// Private to the page: one function for each kind of document, light first.

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report::document {

PageSection rre_section(const ResultDocument& document, const ResultFolder& folder);
PageSection footprint_section(const ResultDocument& document, const ResultFolder& folder);
PageSection far_field_section(const ResultDocument& document, const ResultFolder& folder);

PageSection inspect_section(const ResultDocument& document, const ResultFolder& folder);
PageSection image_section(const ResultDocument& document, const ResultFolder& folder);
PageSection photometry_section(const ResultDocument& document, const ResultFolder& folder);
PageSection roughness_section(const ResultDocument& document, const ResultFolder& folder);
PageSection fabrication_section(const ResultDocument& document, const ResultFolder& folder);
PageSection verification_section(const ResultDocument& document, const ResultFolder& folder);
PageSection forces_section(const ResultDocument& document, const ResultFolder& folder);
PageSection sweep_section(const ResultDocument& document, const ResultFolder& folder);
PageSection optimum_section(const ResultDocument& document, const ResultFolder& folder);
/// Documents that have no section of their own: their figures, and tables of what is in lists.
PageSection plain_section(const ResultDocument& document, const ResultFolder& folder);

}  // namespace retrace::report::document
