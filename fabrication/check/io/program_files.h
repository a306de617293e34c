#pragma once

// NC programs from files, in the dialect that is named or that their text shows.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_texts.h"
#include "fabrication/machine/control.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// The dialect of that word, or of "auto" the one that the text shows.
/// \throw InputError for a word that is none, and for text that shows none
NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file);

/// Lines that a machine's file gives for dialects that have no words of their own.
NcTexts texts_of(const Control& control);

/// A program as it is named: "part.ngc", or "part.ngc@120", which was stopped behind line 120.
struct ProgramName {
  std::string file;
  std::int32_t stop_line = 0;  ///< 0: it runs to its end
};
/// A file that has an @ and a number in its name is that file, if it is there.
ProgramName program_name(const std::string& given);

/// Reads programs, in their order. \param names as program_name() takes them \param texts lines that a control is to
/// take as they are \param given programs in place of files that would be read \throw InputError for a file that cannot
/// be read or understood, with its line, and for a line that it does not have
std::vector<NcProgram> read_programs(const std::vector<std::string>& names, const std::string& dialect,
                                     const NcTexts& texts = {}, const FileTexts& given = {});

}  // namespace retrace::fabrication
