#pragma once

// Internal to library/: what a Design of the library holds.

#include <utility>

#include "retrace/design.h"
#include "studies/design/design.h"

namespace retrace {

struct Design::Content {
  studies::Design design;
};

}  // namespace retrace
