#pragma once

#include <string>

#include "core/schema/schema.h"

namespace retrace::schema {

/// Returns the keys of a format as Markdown tables: one for the root and one for each table with a header. Adjacent
/// tables with equal keys share one Markdown table.
std::string key_tables(const Format& format);

/// Returns the keys of one table as a Markdown table, without the tables within it.
std::string key_table(const Table& table);

/// Returns the rules on keys of several tables as a Markdown table, or an empty text if there are none.
std::string rule_table(const Table& root);

}  // namespace retrace::schema
