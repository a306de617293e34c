#pragma once

// Writes documents and C++ objects as TOML files of their format; the way back from core/schema/reader.h.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/schema/document.h"

namespace retrace::schema {

/// KEY=VALUE, which gives a key that value where a document is read. \pre the value is one of a key, on one line
std::string override_text(std::string_view path, const Value& value);

/// A document as its file: what was given alone. Read again it is the same.
std::string document_text(const Format& format, const Document& document);

/// What of a document is not what would hold without it; tables of which nothing is left are gone too.
Document without_defaults(Document document);

/// An object of the format's root as a document of its file. \pre the format's rows have access
Document document_of(const Format& format, const void* object);

/// The text of an object's file, which reads back to the same object.
std::string object_text(const Format& format, const void* object);

}  // namespace retrace::schema
