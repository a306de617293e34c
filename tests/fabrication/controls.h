#pragma once

// Machines whose control has words for all that programs say, for tests.

#include <string_view>
#include <utility>

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication::test {

/// Lines of a control without words of its own.
inline NcTexts control_texts() {
  return {"", "", "M107", "M109", "M101", "M100"};
}

/// With those lines, and rounding positions as that dialect does.
inline Machine for_dialect(Machine machine, std::string_view dialect) {
  const NcTexts texts = control_texts();
  machine.control.mist_on = texts.mist_on;
  machine.control.mist_off = texts.mist_off;
  machine.control.optional_stop = texts.optional_stop;
  machine.control.stop = texts.stop;
  if (dialect == "fanuc") machine.increments = increments_of(machine.control.increment_system);
  if (dialect == "sinumerik") machine.shortest_axes = machine.control.modulo_axes;
  return machine;
}

}  // namespace retrace::fabrication::test
