#pragma once

// Assigns indices to the subroutines of an NC program while it is read.

#include <cstdint>
#include <map>
#include <string>

#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Table of subroutines by name, and the subroutine that is being read. A call may precede the definition.
class SubroutineTable {
 public:
  explicit SubroutineTable(NcProgram& program) : program_(program) {}

  std::int32_t index_of(const std::string& name) {
    const auto [entry, is_new] = indices_.try_emplace(name, static_cast<std::int32_t>(program_.subroutines.size()));
    if (is_new) program_.subroutines.push_back({name, 0, 0, false});
    return entry->second;
  }

  /// Begins a subroutine at the next block. Returns false if a subroutine with this name exists already.
  bool begin(const std::string& name) {
    open_ = index_of(name);
    if (open().is_complete) return false;
    open().first = program_.blocks.size();
    return true;
  }
  /// Ends the present subroutine after the last block.
  void end() {
    open().last = program_.blocks.size();
    open().is_complete = true;
    open_ = -1;
  }
  bool is_open() const { return open_ >= 0; }
  bool is_open(const std::string& name) { return is_open() && open_ == index_of(name); }

 private:
  NcSubroutine& open() { return program_.subroutines[static_cast<std::size_t>(open_)]; }

  NcProgram& program_;
  std::int32_t open_ = -1;
  std::map<std::string, std::int32_t> indices_;
};

}  // namespace retrace::fabrication
