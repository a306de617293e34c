#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Subroutines by name, whether they are called or defined first.
class SubroutineTable {
 public:
  explicit SubroutineTable(NcProgram& program) : program_(program) {}

  std::int32_t index_of(const std::string& name) {
    const auto [entry, is_new] = indices_.try_emplace(name, static_cast<std::int32_t>(program_.subroutines.size()));
    if (is_new) program_.subroutines.push_back({name, 0, 0, false});
    return entry->second;
  }
  NcSubroutine& get(std::int32_t index) { return program_.subroutines[static_cast<std::size_t>(index)]; }

 private:
  NcProgram& program_;
  std::map<std::string, std::int32_t> indices_;
};

}  // namespace retrace::fabrication
