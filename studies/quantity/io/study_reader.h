#pragma once

// Reads study files, with their parameters, quantities and analysis, and makes the candidate of a point.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/file_texts.h"
#include "core/warning.h"
#include "studies/quantity/candidate.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Reads and checks a study file; "-" is standard input.
/// \param overrides values of the option `--set`: keys of the design, of [analysis] and of [machining]
/// \throw InputError with a message on one line that contains file, line, key, the allowed values and the given value
Study read_study(const std::filesystem::path& file, std::span<const std::string> overrides = {},
                 std::uint32_t seed = 1);

/// Reads the text of a study and the designs that it names.
/// \param designs texts of designs that replace the design files
Study parse_study(const std::string& text, const std::string& source_name, std::span<const std::string> overrides = {},
                  std::uint32_t seed = 1, const FileTexts& designs = {});

/// Returns the design of a study at one point, with its analysis.
/// \param values one value for each parameter
/// \throw InputError if the design is invalid
Candidate make_candidate(const Study& study, std::span<const ParameterValue> values);

/// Returns a warning for each key that has no effect. The keys are checked in one example design of the study. If the
/// example is invalid, there are no warnings.
Warnings keys_without_effect(const Study& study);

}  // namespace retrace::studies
