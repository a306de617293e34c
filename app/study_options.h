#pragma once

#include <string>
#include <vector>

#include "app/command_line.h"
#include "studies/quantity/study.h"
#include "studies/store/store.h"

namespace retrace::app {

/// \throw InputError for --resume or --overwrite without a folder
void check_study_options(const CommandLine& line);

studies::IfExists if_exists_of(const StudyOptions& options);

/// The files that a study was read from.
std::vector<std::string> files_of_study(const studies::Study& study);

}  // namespace retrace::app
