#pragma once

// Reads TOML text against the rows of a format into a document or a C++ object, and checks keys, values and rules on
// the way.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/schema/document.h"
#include "core/toml_file.h"

namespace retrace::schema {

/// Reads a document and checks it against the format. Every key must be known, must have an allowed value, and must be
/// meaningful together with the other keys.
/// \param source_name name of the file in messages; file names in the document are relative to the folder of this file
/// \param most_bytes maximum length of the text in bytes
/// \param overrides texts of the form KEY=VALUE, which set a key, or KEY=, which remove a key
/// \throw InputError with file, line and key if a value is not allowed; also if the text is not TOML or is longer than
/// `most_bytes`
Document read_document(const Format& format, std::string_view text, const std::string& source_name,
                       std::size_t most_bytes = kMostTextBytes, std::span<const std::string> overrides = {});

/// Reads the text of a document again, with further overrides, and checks the result like read_document().
/// \throw InputError
Document with(const Format& format, const Document& document, std::span<const std::string> overrides);

/// Reads the names and texts of a document that may be invalid, without checks. Returns the part that can be read. The
/// result is used to find the files that the document refers to.
Document unchecked_names(const Format& format, std::string_view text, const std::string& source_name,
                         std::size_t most_bytes, std::span<const std::string> overrides);

/// Returns a warning for each key that has no effect because another key takes precedence over it. Keys with their
/// default value cause no warning.
std::vector<std::string> superseded_keys(const Document& document);

/// Reads a document into an object, which is that of the format's root.
/// \throw InputError likewise, and where values that are allowed each by itself do not fit together
Document read_object(const Format& format, std::string_view text, const std::string& source_name, void* object);

/// Fills the object of a table at `path` of a document. \throw InputError where its values do not fit together
void fill(const Document& document, const Table& table, const std::string& path, void* object);

/// Checks the rules of a table at `path` of a document, which fill() does as well. \param object of the table, or the
/// document \throw InputError where its values do not fit together
void check(const Document& document, const Table& table, const std::string& path, const void* object);
/// The same of an object that is from no document.
void check(const Table& table, const void* object, const Refuse& refuse);

/// The paths of all keys that a value can be given for; a list of tables is one.
std::vector<std::string> keys_of(const Format& format);

/// Whether the format has that key, and it may be a number.
bool is_number_key(const Format& format, std::string_view path);

/// What is wrong with `path` as the path of a key of the format, such as "element.base_mm", with a "did you mean" where
/// a known name is close; empty if a document may have it.
std::string complaint_about_key(const Format& format, std::string_view path);

}  // namespace retrace::schema
