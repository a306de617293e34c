#pragma once

#include <string>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// The result as a `retrace.rre/1` document.
std::string rre_json(const RreResult& result);

/// One line a point; the header holds the keys of the JSON.
std::string rre_csv(const RreResult& result);

/// A table for a terminal: RRE and its standard error in percent.
std::string rre_table(const RreResult& result);

}  // namespace retrace::studies
