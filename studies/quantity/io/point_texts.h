#pragma once

// Converts a point of a study to texts: the name of its design file, and overrides of keys in the design file and in
// the study file. A candidate (design with settings) is then made from these texts.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "design/io/design_reader.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Returns true if the key is a setting of the analysis or the machining, and not a key of the design.
bool is_setting(std::string_view key);

/// Returns the key of an override.
std::string key_of(const std::string& override_text);
/// Returns the path of a key of a design or a study, with former names replaced by current names.
std::string current_key(std::string_view key);

/// Selects overrides by the file to which they apply: the study file if `study` is true, otherwise design files.
std::vector<std::string> overrides_for(std::span<const std::string> overrides, bool study);

/// Point of a study: its design file, and the overrides with which the design file and the study file are read.
struct PointTexts {
  std::string design;                   ///< name of the design file
  std::vector<std::string> for_design;  ///< overrides of the design file
  std::vector<std::string> for_study;   ///< overrides of the study file, in addition to those with which it was read
};

/// Returns the files and overrides of one point.
/// \param values one value for each parameter
PointTexts texts_at(const Study& study, std::span<const ParameterValue> values);

/// Returns the files that the designs of a study name, without duplicates. If a parameter of the study sets the key of
/// a file, the files of all values of the parameter are included. For messages, such files have the position of the
/// parameter.
std::vector<design::NamedFile> files_of_designs(const Study& study);

}  // namespace retrace::studies
