#pragma once

// JSON Schema of a file format, for editors that complete and check TOML files while they are written.

#include <nlohmann/json_fwd.hpp>

#include "core/schema/schema.h"

namespace retrace::schema {

/// Returns the format as JSON Schema (draft-07, which TOML editors support). Tables do not allow unknown keys.
/// Conditions become `if` and `then` in the table that contains the key of the condition. Rules on several values that
/// a schema cannot express are written into the descriptions.
nlohmann::ordered_json json_schema(const Format& format);

}  // namespace retrace::schema
