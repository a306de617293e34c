#pragma once

#include "studies/design/design.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {

/// The keys of [surface] that say how facets scatter light, and whether walls absorb it. \throw InputError
FacetTexture read_texture(TableReader& surface);

}  // namespace retrace::studies
