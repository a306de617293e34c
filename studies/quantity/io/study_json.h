#pragma once

// Begins the documents of results of studies.

#include <nlohmann/json.hpp>

#include "studies/quantity/study.h"

namespace retrace::studies {

/// Returns an object with the file and the title of a study. The title is omitted if the study has none.
nlohmann::ordered_json begin_document(const Study& study);

}  // namespace retrace::studies
