#pragma once

// Converts result documents to tables, values and texts of the page. Members that are missing or have an unexpected
// type are treated as absent. This header is private to the page.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report::document {

using Json = nlohmann::ordered_json;

/// Maximum number of rows of a table on the page. The limit keeps the page small. The result files contain all rows.
inline constexpr std::size_t kMaxRows = 400;

const Json& member(const Json& json, const char* key);  ///< returns a member; null if absent
double number(const Json& json, const char* key);       ///< returns a number; NaN if absent
double number_or_0(const Json& json, const char* key);  ///< returns a number; 0 if absent
/// Returns a number that counts objects. Returns 0 if the number is absent or negative.
std::size_t count_in(const Json& json, const char* key);
std::string text(const Json& json, const char* key);
bool flag(const Json& json, const char* key);
const Json& list(const Json& json, const char* key);  ///< returns a list; empty if absent

/// Returns a number with its unit. Returns an empty text if the number is not finite.
std::string measured(double value, int digits, const char* unit);
/// Returns a number with six digits and its unit. Returns an empty text if the number is not finite.
std::string measured(double value, const char* unit);
std::string percent(double fraction);

PageCell cell_of(const Json& value);
/// Converts a key to the title of a column, for example "incidence_deg" to "incidence (deg)".
std::string column_name(const std::string& key);
/// Returns a table with one row for each object of a list. It has a column for each key of `keys` that occurs in at
/// least one object. If the objects have a verdict (`verdict`, `passes` or `holds`), its cells are rated and the rows
/// are sorted: failed rows come first, then undetermined rows, then all others.
PageTable table_of(const Json& rows, const std::vector<std::string>& keys, const std::string& caption,
                   const std::string& csv_name);
/// Returns a table with one row for each member of a JSON object. Members that are objects or lists are omitted.
PageTable figures_of(const Json& json, const std::string& caption, const std::string& csv_name);
std::string csv_name(const ResultDocument& document, const char* what);

/// Returns the rating of a verdict: good for "pass", bad for "fail", and open for all others.
Rating rating_of(const std::string& verdict);
/// Returns the rating of the value of a key: that of its verdict if the key contains one, otherwise none.
Rating rating_of(const std::string& key, const Json& value);
std::string name_of_design(const Json& design);
/// Returns the keys that occur in the first 20 objects of a list, in the order in which the keys first occur.
std::vector<std::string> keys_of(const Json& rows);
/// Returns the strings in a JSON list.
std::vector<std::string> words(const Json& values);

}  // namespace retrace::report::document
