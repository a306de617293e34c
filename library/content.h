#pragma once

// Internal to library/: data of a Design.

#include <string>
#include <vector>

#include "retrace/design.h"
#include "studies/design/design.h"

namespace retrace {

struct Design::Content {
  studies::Design design;
  std::string text;
  std::vector<std::string> overrides;
};

}  // namespace retrace
