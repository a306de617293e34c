#pragma once

// The readers of NC text by dialect (RS274NGC, Sinumerik, Fanuc, Power PMAC, Aerotech), each written from its published
// rules and apart from the writers in post/.

#include <string>
#include <string_view>

#include "fabrication/read/nc_program.h"
#include "fabrication/read/nc_text.h"

namespace retrace::fabrication {

/// NIST RS274NGC as LinuxCNC has it: `o101 sub` ... `o101 endsub`, `o101 call`.
/// (Kramer, Proctor, Messina: The NIST RS274NGC Interpreter, NISTIR 6556, 2000; LinuxCNC G-code reference)
NcProgram parse_rs274ngc(NcLines lines, const NcTexts&);

/// Siemens Sinumerik 840D: labels with CALL BLOCK ... TO ..., MSG, TRAFOOF. (Programming Manual Fundamentals)
NcProgram parse_sinumerik(NcLines lines, const NcTexts&);

/// Fanuc series 30i: O numbers, M98 P, M99. Axis words need a decimal point: without one they are least increments,
/// whose size the text does not tell. (Operator's Manual B-63944)
NcProgram parse_fanuc(NcLines lines, const NcTexts&);

/// Omron/Delta Tau Power PMAC: open prog ... close, rapid, linear, abs, inc, dwell in ms, call.
/// (Power PMAC User's Manual; Software Reference)
NcProgram parse_pmac(NcLines lines, const NcTexts& texts);

/// Aerotech A3200: AeroBasic statements and the G codes of its CNC option; END PROGRAM, DFS ... ENDDFS, CALL. (A3200.h
/// of the C library; what public programs for it say)
NcProgram parse_a3200(NcLines lines, const NcTexts& texts);

/// Aerotech Automation1: AeroScript's program ... end, function ... end, its functions for settings and moves, and its
/// G codes. (help.aerotech.com/automation1)
NcProgram parse_automation1(NcLines lines, const NcTexts& texts);

/// What a text that stopped in the middle of its last line leaves: the error that this gave, as a remark.
/// Runs `read`, and turns an InputError in an open last line into NcProgram::truncated.
template <class Read>
void read_line_that_may_be_cut(const NcLines& lines, NcProgram& program, Read read) {
  if (!lines.is_open_end()) {
    read();
    return;
  }
  try {
    read();
  } catch (const InputError&) {
    program.truncated = "the text ends within this line";
  }
}

}  // namespace retrace::fabrication
