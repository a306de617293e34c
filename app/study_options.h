#pragma once

#include <string>
#include <vector>

#include "app/command_line.h"
#include "studies/store/store.h"

namespace retrace::app {

/// \throw InputError for --resume or --overwrite without a folder
void check_study_options(const CommandLine& line);

studies::IfExists if_exists_of(const StudyOptions& options);

}  // namespace retrace::app
