#pragma once

#include <string>

#include "core/schema/schema.h"

namespace retrace::schema {

/// The keys of a table as TOML, in the order of its rows, under its head `[name]`; those of a root without one.
/// read_table() reads the same values from them. \param object of the type that the rows are of
std::string table_text(const Table& table, const void* object);

/// The text of a whole file, which read_document() reads.
std::string document_text(const Format& format, const void* object);

}  // namespace retrace::schema
