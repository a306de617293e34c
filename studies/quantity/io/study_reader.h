#pragma once

// Reads study files - parameters, quantities, analysis - and makes the candidate of a point.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/file_texts.h"
#include "studies/quantity/candidate.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Reads and checks what every study file says; "-" is standard input.
/// \param overrides `--set`: keys of the design, of [analysis] and of [machining]
/// \throw InputError naming file, line, key, what was given and what is allowed, on one line
Study read_study(const std::filesystem::path& file, std::span<const std::string> overrides = {},
                 std::uint32_t seed = 1);

/// The same for the text of a study; the designs that it names are read. \param designs that are given in place of it
Study parse_study(const std::string& text, const std::string& source_name, std::span<const std::string> overrides = {},
                  std::uint32_t seed = 1, const FileTexts& designs = {});

/// The design of a study at one point, with its analysis. \param values one for each parameter \throw InputError
Candidate make_candidate(const Study& study, std::span<const ParameterValue> values);

/// Returns a warning for each key that has no effect. The keys are checked in one example design of the study. If the
/// example is invalid, there are no warnings.
std::vector<std::string> keys_without_effect(const Study& study);

}  // namespace retrace::studies
