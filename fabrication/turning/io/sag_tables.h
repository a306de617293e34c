#pragma once

#include <string>
#include <vector>

#include "core/schema/document.h"
#include "fabrication/turning/boundary.h"
#include "fabrication/turning/sag.h"

// Tables of a part file that describe a sag or a boundary.

namespace retrace::fabrication::turning {

/// The sag of `[base]` or `[lenslets]`.
Sag read_sag(const schema::Document& file, const std::string& table);

/// The curve of `[boundary]`. \pre it was given
Boundary read_boundary(const schema::Document& file);

/// Of a key with rows [x, y].
std::vector<geometry::Vec2> read_points(const schema::Document& file, std::string_view key);

}  // namespace retrace::fabrication::turning
