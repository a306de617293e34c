#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::schema {

/// A document as its file: what was given alone. Read again it is the same.
std::string document_text(const Format& format, const Document& document);

/// An object of the format's root as a document of its file. \pre the format's rows have access
Document document_of(const Format& format, const void* object);

/// The text of an object's file, which reads back to the same object.
std::string object_text(const Format& format, const void* object);

/// The same of a table of a larger document, with its head.
std::string table_text(const Table& table, const void* object);

}  // namespace retrace::schema
