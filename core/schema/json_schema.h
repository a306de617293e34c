#pragma once

// JSON Schema of a file format, for editors that complete and check TOML files while they are written.

#include <nlohmann/json_fwd.hpp>

#include "core/schema/schema.h"

namespace retrace::schema {

/// The format as JSON Schema (draft-07, which editors of TOML know): tables are closed, conditions are `if` and `then`
/// of the table that has the word, what a schema cannot say of values together stands in descriptions.
nlohmann::ordered_json json_schema(const Format& format);

}  // namespace retrace::schema
