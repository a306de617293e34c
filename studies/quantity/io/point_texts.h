#pragma once

// A point of a study as overrides of its design and study files, which is how a candidate is made.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/design/io/design_reader.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Whether an override or a parameter is one of how designs are analysed or made.
bool is_setting(std::string_view key);

/// The key of an override.
std::string key_of(const std::string& override_text);

/// Those of the overrides that are meant for the study file, or for designs.
std::vector<std::string> overrides_for(std::span<const std::string> overrides, bool study);

/// A point of a study as the files that are read for it.
struct PointTexts {
  std::string design;                   ///< file
  std::vector<std::string> for_design;  ///< overrides
  std::vector<std::string> for_study;   ///< overrides of its document, beside those that it was read with
};

/// \param values one for each parameter
PointTexts texts_at(const Study& study, std::span<const ParameterValue> values);

/// Returns the files that the designs of a study name, without duplicates. If a parameter of the study sets the key of
/// a file, the files of all values of the parameter are included. Their position is that of the parameter.
std::vector<NamedFile> files_of_designs(const Study& study);

}  // namespace retrace::studies
