#pragma once

// Private to the page: result documents as tables, figures and texts. Whatever a document lacks, or has with another
// type, reads as absent.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/page/page.h"
#include "report/page/result_folder.h"

namespace retrace::report::document {

using Json = nlohmann::ordered_json;

/// Rows of a table: a page must stay small enough to be sent on, the files have everything.
inline constexpr std::size_t kMostRows = 400;

const Json& member(const Json& json, const char* key);  ///< null if absent
double number(const Json& json, const char* key);       ///< not a number if absent
std::string text(const Json& json, const char* key);
bool flag(const Json& json, const char* key);
const Json& list(const Json& json, const char* key);  ///< empty if absent

/// With a unit; empty for a value that is not finite.
std::string measured(double value, int digits, const char* unit);
/// The same with six digits.
std::string measured(double value, const char* unit);
std::string percent(double share);

PageCell cell_of(const Json& value);
/// "incidence_deg" as a person would write it: "incidence (deg)".
std::string column_name(const std::string& key);
/// A table of a list of objects; its columns are the given keys that any of them has.
PageTable table_of(const Json& rows, const std::vector<std::string>& keys, const std::string& caption,
                   const std::string& csv_name);
/// The plain members of an object: one row each.
PageTable figures_of(const Json& json, const std::string& caption, const std::string& csv_name);
std::string csv_name(const ResultDocument& document, const char* what);

/// The series of that label, made if there is none.
ChartSeries& series_of(PageChart& chart, const std::string& label);

/// "good", "bad" or "open".
std::string verdict_style(const std::string& verdict);
std::string name_of_design(const Json& design);
/// The keys of the first rows of a list, in their order.
std::vector<std::string> keys_of(const Json& rows);
/// The texts in a list.
std::vector<std::string> words(const Json& values);

}  // namespace retrace::report::document
