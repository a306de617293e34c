#pragma once

#include <string>

#include "core/schema/schema.h"

namespace retrace::schema {

/// The keys of a format as tables in Markdown, one for the root and one for each table with a head; tables in a row
/// that have the same keys share one.
std::string key_tables(const Format& format);

/// The same of the keys of one table alone, without what is in tables below it.
std::string key_table(const Table& table);

/// What holds between keys of several tables, as a table in Markdown. Empty without such rules.
std::string rule_table(const Table& root);

}  // namespace retrace::schema
