#pragma once

#include <optional>

#include "core/schema/document.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The keys of [light] that describe a spectrum; nothing if there is none. Files are named, not read. \throw InputError
std::optional<LightSpectrum> read_spectrum(const schema::Document& document);

}  // namespace retrace::studies
