#pragma once

#include "core/schema/document.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// What `[surface]` says of the texture of the retro facets. Files are named, not read. \throw InputError
FacetTexture read_texture(const schema::Document& document);

}  // namespace retrace::studies
