#pragma once

#include <toml++/toml.h>

#include <string>

namespace retrace {

/// A value of a TOML tree as a message shows it: -3, "text", a table, a list.
std::string shown(const toml::node& node);

}  // namespace retrace
