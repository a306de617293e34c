#pragma once

// Writes documents and C++ objects as TOML files of their format. This is the inverse of core/schema/reader.h.

#include <string>
#include <string_view>

#include "core/schema/document.h"

namespace retrace::schema {

/// Returns the override KEY=VALUE, which sets a key when a document is read.
/// \pre the value is that of a single key and fits on one line
std::string override_text(std::string_view path, const Value& value);

/// Converts a document to the text of a file, which contains only the given keys. Reading this text gives the same
/// document.
std::string document_text(const Format& format, const Document& document);

/// Returns the document without keys that have their default value, and without tables that become empty.
Document without_defaults(Document document);

/// Converts an object to a document.
/// \param object object of the root table of the format
/// \pre the rows of the format have access functions
Document document_of(const Format& format, const void* object);

/// Converts an object to the text of a file. Reading this text gives an equal object.
std::string object_text(const Format& format, const void* object);

}  // namespace retrace::schema
