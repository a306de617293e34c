#pragma once

#include <string>
#include <vector>

#include "app/command.h"
#include "studies/store/store.h"

namespace retrace::app {

/// Of commands that keep their points in a store.
struct StudyOptions {
  std::string study;
  bool resume = false;
  bool overwrite = false;
};

/// STUDY and what is done with a store that is there.
std::vector<Argument> study_arguments(StudyOptions& options);

/// \throw InputError for --resume or --overwrite without a folder
void check_study_options(const StudyOptions& options, const CommonOptions& common);

/// What is done with a store that is there.
studies::IfExists if_exists_of(const StudyOptions& options);

}  // namespace retrace::app
