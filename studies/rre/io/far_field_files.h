#pragma once

#include <string>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// The directions in which light leaves the entrance face as a `retrace.far_field/1` document.
/// \pre a far field was asked for
std::string far_field_json(const RreResult& result);

/// One line a spot; the header holds the keys of the JSON.
std::string far_field_csv(const RreResult& result);

}  // namespace retrace::studies
