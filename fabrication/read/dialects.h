#pragma once

// Readers of NC text for each dialect (RS274NGC, Sinumerik, Fanuc, Power PMAC, Aerotech). They are based on published
// rules and share no code with the writers in post/.

#include "fabrication/read/nc_program.h"
#include "fabrication/read/nc_text.h"

namespace retrace::fabrication {

/// Reads NIST RS274NGC with the extensions of LinuxCNC: `o101 sub` ... `o101 endsub`, `o101 call`.
/// (Kramer, Proctor, Messina: The NIST RS274NGC Interpreter, NISTIR 6556, 2000; LinuxCNC G-code reference)
NcProgram parse_rs274ngc(NcLines lines, const NcTexts&);

/// Reads Siemens Sinumerik 840D: labels with REPEAT or CALL BLOCK ... TO ..., MSG, TRAFOOF. (Programming Manual
/// Fundamentals)
NcProgram parse_sinumerik(NcLines lines, const NcTexts&);

/// Reads Fanuc series 30i: O numbers, M98 P, M99. Axis words need a decimal point. Without it, their unit would be the
/// least increment, which is not known from the program. (Operator's Manual B-63944)
NcProgram parse_fanuc(NcLines lines, const NcTexts&);

/// Reads Omron/Delta Tau Power PMAC: open prog ... close, rapid, linear, abs, inc, dwell in ms, call.
/// (Power PMAC User's Manual; Software Reference)
NcProgram parse_pmac(NcLines lines, const NcTexts& texts);

/// Reads Aerotech A3200: AeroBasic statements and the G codes of its CNC option, END PROGRAM, DFS ... ENDDFS, CALL.
/// (A3200.h of the C library; public A3200 programs)
NcProgram parse_a3200(NcLines lines, const NcTexts& texts);

/// Reads Aerotech Automation1: program ... end, function ... end, AeroScript functions for settings and moves, and G
/// codes. (help.aerotech.com/automation1)
NcProgram parse_automation1(NcLines lines, const NcTexts& texts);

/// Calls `read` for a line. If the last line has no line end, the file may be truncated in this line. An InputError
/// about this line is therefore not thrown, but stored in NcProgram::truncated.
template <class Read>
void read_line_that_may_be_cut(const NcLines& lines, NcProgram& program, Read read) {
  if (!lines.is_open_end()) {
    read();
    return;
  }
  try {
    read();
  } catch (const InputError&) {
    program.truncated = "the file ends within this line";
  }
}

}  // namespace retrace::fabrication
