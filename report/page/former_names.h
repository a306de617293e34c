#pragma once

// Reads result documents of former versions, such as retrace.inspect/1, in which some keys had other names.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::report {

/// Key of result documents, or text value of such a key, that has been renamed.
struct FormerName {
  std::string kind;  ///< kind of the document, such as "inspect"; empty for keys of designs in all documents
  /// Path of the key in documents of former versions. "[]" is appended to the name of a list. If the value was renamed
  /// and not the key, "=" and the former value are appended.
  std::string former;
  std::string current;  ///< path in the same form in documents of the current version
};

/// Returns all renamed keys and values. Those for designs are taken from the format of design files. If a key and a key
/// within its value were renamed, the outer key comes first.
const std::vector<FormerName>& former_names();

/// Returns the current version of a kind of document, for example 2 for the kind "inspect".
int current_version(std::string_view kind);

/// Kind and version of a result document. For "retrace.inspect/1", they are "inspect" and "1".
struct DocumentSchema {
  std::string kind;  ///< empty for documents of other programs
  std::string version;
};

DocumentSchema schema_of(const nlohmann::ordered_json& document);

/// Replaces the former names in a result document by the current names. The order of the keys and the value of `schema`
/// do not change. Documents of other programs do not change.
/// \param file path of the file in messages
/// \throw InputError if the version of the document is later than the current version
void replace_former_names(nlohmann::ordered_json& document, const std::string& file = {});

/// Returns a result document in the current version: with the current names and the current `schema`. A document that
/// is of the current version is returned unchanged.
/// \param text the document as JSON; any other text is returned unchanged
/// \throw InputError if the version of the document is later than the current version
std::string current_document(const std::string& text);

}  // namespace retrace::report
