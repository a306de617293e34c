#include "fabrication/machine/control.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/leading_number.h"

namespace retrace::fabrication {
namespace {

constexpr std::size_t kLongestLine = 200;

/// Pattern of a program line that neither moves an axis nor waits. The placeholders are # for a whole number, ~ for a
/// number and @ for the name of an axis. Blanks are ignored.
struct LineForm {
  std::string_view dialect;
  LineUse use;
  std::string_view form;
};

/// M codes that control the program flow, such as stops and calls. All other M codes are defined by the machine builder
/// (ISO 6983-1).
constexpr int kFlowCodes[] = {0, 1, 2, 30, 47, 48, 49, 96, 97, 98, 99};

constexpr LineForm kLineForms[] = {
    // Forms of the Power PMAC. Source: Power PMAC Software Reference, variables and M codes.
    {"pmac", LineUse::output, "M#"},
    {"pmac", LineUse::output, "P#=~"},
    {"pmac", LineUse::output, "Q#=~"},
    {"pmac", LineUse::output, "M#=~"},
    {"pmac", LineUse::output, "Gate3[#].GpioData[#].#=#"},
    {"pmac", LineUse::output, "GateIo[#].DataReg[#].#=#"},
    {"pmac", LineUse::stop, "M0"},
    {"pmac", LineUse::stop, "M1"},
    // Forms of the A3200. Source: outputs and variables in public A3200 programs.
    {"a3200", LineUse::output, "M#"},
    {"a3200", LineUse::output, "$DO[#].@=#"},
    {"a3200", LineUse::output, "$AO[#].@=~"},
    {"a3200", LineUse::output, "$global[#]=~"},
    {"a3200", LineUse::stop, "M0"},
    {"a3200", LineUse::stop, "M1"},
    // Forms of the Automation1. Source: help.aerotech.com/automation1, I/O Functions and Variables.
    {"automation1", LineUse::output, "M#"},
    {"automation1", LineUse::output, "DigitalOutputSet(@,#,#)"},
    {"automation1", LineUse::output, "AnalogOutputSet(@,#,~)"},
    {"automation1", LineUse::output, "VirtualBinaryOutputSet(#,#)"},
    {"automation1", LineUse::output, "$iglobal[#]=~"},
    {"automation1", LineUse::output, "$rglobal[#]=~"},
    {"automation1", LineUse::stop, "M0"},
    {"automation1", LineUse::stop, "M1"},
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Removes a number or name from the front of `text`.
/// \param sign # for a whole number, ~ for a number, @ for the name of an axis
/// \return false if `text` does not begin with it
bool take_part(char sign, std::string_view& text) {
  const std::size_t before = text.size();
  if (sign == '@') {
    while (!text.empty() && text.front() >= 'A' && text.front() <= 'Z') text.remove_prefix(1);
    return text.size() < before;
  }
  if (sign == '~' && text.starts_with('-')) text.remove_prefix(1);
  bool has_digit = false;
  bool has_point = sign != '~';
  for (; !text.empty() && (is_digit(text.front()) || (text.front() == '.' && !has_point)); text.remove_prefix(1))
    (is_digit(text.front()) ? has_digit : has_point) = true;
  return has_digit;
}

bool has_form(std::string_view text, std::string_view form) {
  for (; !form.empty(); form.remove_prefix(1)) {
    if (std::string_view("#~@").find(form.front()) != std::string_view::npos) {
      if (!take_part(form.front(), text)) return false;
      continue;
    }
    if (text.empty() || text.front() != form.front()) return false;
    text.remove_prefix(1);
  }
  return text.empty();
}

bool is_flow_code(std::string_view text) {
  if (!has_form(text, "M#")) return false;
  const double code = leading_number(text.substr(1))->value;
  return std::find(std::begin(kFlowCodes), std::end(kFlowCodes), code) != std::end(kFlowCodes);
}

}  // namespace

std::string line_error(std::string_view text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (!text.empty() && text.size() <= kLongestLine && is_plain && text.front() != ' ' && text.back() != ' ' &&
      text.find("//") == std::string_view::npos)
    return "";
  return fmt::format(
      "must be one line of 1 to {} printable ASCII characters, without // and without blanks at its ends",
      kLongestLine);
}

bool is_harmless_line(std::string_view text, LineUse use, std::string_view dialect) {
  std::string packed(text);
  std::erase(packed, ' ');
  const bool flows = is_flow_code(packed);
  return std::any_of(std::begin(kLineForms), std::end(kLineForms), [&](const LineForm& line) {
    const bool fits_use = flows ? use == LineUse::stop && line.use == LineUse::stop : line.use == LineUse::output;
    return fits_use && (dialect.empty() || dialect == line.dialect) && has_form(packed, line.form);
  });
}

std::string line_form_error(std::string_view text, LineUse use, std::string_view dialect) {
  if (is_harmless_line(text, use, dialect)) return "";
  std::vector<std::string_view> forms;
  for (const LineForm& line : kLineForms)
    if (line.use == LineUse::output && (dialect.empty() || dialect == line.dialect) &&
        std::find(forms.begin(), forms.end(), line.form) == forms.end())
      forms.push_back(line.form);
  return fmt::format("must set an output or a variable, such as {} (# is a whole number, ~ is a number, @ is an axis)",
                     fmt::join(forms, ", "));
}

}  // namespace retrace::fabrication
