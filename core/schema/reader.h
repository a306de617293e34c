#pragma once

// Reads TOML text of a given format into a document or a C++ object, and checks keys, values and rules.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/schema/document.h"
#include "core/toml_file.h"
#include "core/warning.h"

namespace retrace::schema {

/// Reads a document and checks it against the format. Every key must be known, must have an allowed value, and must be
/// meaningful together with the other keys.
/// \param source_name name of the file in messages; file names in the document are relative to the folder of this file
/// \param max_bytes maximum length of the text in bytes
/// \param overrides texts of the form KEY=VALUE, which set a key, or KEY=, which remove a key
/// \throw InputError with file, line and key if a value is not allowed; also if the text is not TOML or is longer than
/// `max_bytes`
Document read_document(const Format& format, std::string_view text, const std::string& source_name,
                       std::size_t max_bytes = kMaxTextBytes, std::span<const std::string> overrides = {});

/// Reads the text of a document again, with further overrides, and checks the result like read_document().
/// \throw InputError
Document with(const Format& format, const Document& document, std::span<const std::string> overrides);

/// Reads a document that may be invalid, without checks of its values. Returns the keys that can be read, with the
/// values of keys whose value is a text. The result is used to find the files that the document refers to.
Document unchecked_names(const Format& format, std::string_view text, const std::string& source_name,
                         std::size_t max_bytes, std::span<const std::string> overrides);

/// Returns a warning for each key that has no effect because another key takes precedence over it. Keys with their
/// default value cause no warning.
Warnings superseded_keys(const Document& document);
/// Returns a warning for each former name in the input of a document. The warning contains the current name.
Warnings renamed_keys(const Document& document);

/// Returns the former names of all tables, keys and words of a format, in the order that parse_toml() requires.
std::vector<TomlRename> former_names(const Format& format);

/// Reads a document and stores its values in an object.
/// \param object object of the root table of the format
/// \throw InputError like read_document(), or if a combination of values violates a rule
Document read_object(const Format& format, std::string_view text, const std::string& source_name, void* object);

/// Stores the values of a table in an object, and checks the rules of the table.
/// \param path path of the table in the document
/// \throw InputError if a combination of values violates a rule
void fill(const Document& document, const Table& table, const std::string& path, void* object);

/// Checks the rules of a table. fill() calls this function as well.
/// \param path path of the table in the document
/// \param object object of the table, or the address of `document` if the format is only read as a document
/// \throw InputError if a combination of values violates a rule
void check(const Document& document, const Table& table, const std::string& path, const void* object);
/// Checks the rules of a table for an object that was not read from a document.
/// \param refuse function that is called for each violated rule
void check(const Table& table, const void* object, const Refuse& refuse);

/// Returns the paths of all keys of a format. A list of tables counts as one key.
std::vector<std::string> keys_of(const Format& format);

/// Returns true if the format has a key with this path whose value may be a number.
bool is_number_key(const Format& format, std::string_view path);

/// Checks that the format has a key with this path, such as "element.base_mm".
/// \return an empty text if the key exists; otherwise a message, which proposes a similar key if there is one
std::string complaint_about_key(const Format& format, std::string_view path);

}  // namespace retrace::schema
