#pragma once

// Machine codes for tests with controls that have no standard codes for mist and stops.

#include <string_view>
#include <utility>

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication::test {

/// Returns example codes for mist and stops.
inline NcTexts control_texts() {
  return {"", "", "M107", "M109", "M101", "M100"};
}

/// Returns the machine with the codes of control_texts(). Its control rounds positions as the dialect requires.
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
