#pragma once

// Internal to library/: data of a Design.

#include <string>
#include <vector>

#include "design/design.h"
#include "retrace/design.h"

namespace retrace {

struct Design::Content {
  design::Design design;
  std::string text;
  std::vector<std::string> overrides;
};

}  // namespace retrace
