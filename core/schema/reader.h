#pragma once

#include <string>
#include <string_view>

#include "core/schema/schema.h"
#include "core/toml_file.h"

namespace retrace::schema {

/// Reads what the rows of `table` say into its object, checks it by itself and by the table's rules. Keys that no row
/// has are left for TomlTable::finish().
/// \param object of the type that the rows are of, just made \throw InputError
void read_table(const Table& table, const TomlTable& source, void* object);

/// Reads a whole file of the format; `source_name` stands for it in messages.
/// \param object of the type that the root's rows are of, just made \throw InputError, for keys it does not have too
void read_document(const Format& format, std::string_view text, const std::string& source_name, void* object);

}  // namespace retrace::schema
