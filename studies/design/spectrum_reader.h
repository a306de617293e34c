#pragma once

#include <optional>

#include "studies/design/design.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {

/// The keys of [light] that describe a spectrum; nothing if there is none. Files are named, not read. \throw InputError
std::optional<LightSpectrum> read_spectrum(TableReader& light);

}  // namespace retrace::studies
