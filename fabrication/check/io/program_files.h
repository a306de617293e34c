#pragma once

// Reads NC programs from files, in a given dialect or in the dialect that is recognised from the text.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_texts.h"
#include "fabrication/machine/control.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Returns the dialect with the given name. If the name is "auto", the dialect is recognised from the text of the
/// program.
/// \param word name of the dialect, or "auto"
/// \param file file name for error messages
/// \throw InputError for an unknown name, or if the dialect cannot be recognised
NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file);

/// Returns the program lines for mist and stops that the machine file defines. Programs contain these lines in dialects
/// without standard codes for mist and stops.
NcTexts texts_of(const Control& control);

/// Name of a program: "part.ngc", or "part.ngc@120" for a program that was stopped after line 120.
struct ProgramName {
  std::string file;
  std::int32_t stop_line = 0;  ///< line after which the program was stopped; 0: it ran to its end
};
/// Splits a name such as "part.ngc@120" into file name and stop line. If a file with the complete name exists, "@120"
/// is part of the file name, and there is no stop line.
ProgramName program_name(const std::string& given);

/// Reads programs in the given order.
/// \param names file names, each with an optional stop line (see program_name())
/// \param dialect name of the dialect, or "auto"
/// \param texts program lines that the machine file defines
/// \param given texts of files. A file in this list is not read from the disk
/// \throw InputError for a file that cannot be read or understood, or if the stop line does not exist
std::vector<NcProgram> read_programs(const std::vector<std::string>& names, const std::string& dialect,
                                     const NcTexts& texts = {}, const FileTexts& given = {});

}  // namespace retrace::fabrication
