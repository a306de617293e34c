#pragma once

// NC programs from files, in the dialect that is named or that their text shows.

#include <string>
#include <string_view>
#include <vector>

#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// The dialect of that word, or of "auto" the one that the text shows.
/// \throw InputError for a word that is none, and for text that shows none
NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file);

/// Reads programs, in their order. \param texts lines that a PMAC is to take as they are
/// \throw InputError for a file that cannot be read or understood, with its line
std::vector<NcProgram> read_programs(const std::vector<std::string>& files, const std::string& dialect,
                                     const NcTexts& texts = {});

}  // namespace retrace::fabrication
