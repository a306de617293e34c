#pragma once

// Data types for findings. A finding is an error that a check found in an NC program.

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace retrace::fabrication {

/// Error in a program.
struct Finding {
  std::string kind;           ///< kind, such as "gouge"; docs/commands/verify.md lists all kinds
  std::string program;        ///< file name; empty if the finding belongs to no single program
  std::int32_t line = 0;      ///< line of the program; 0: no line
  std::int64_t element = -1;  ///< number of the element; -1: no element
  std::string message;
  double value = 0.0;  ///< actual value, in the unit that `message` uses; 0 if the finding has no value
  double limit = 0.0;
  std::int64_t count = 1;  ///< number of occurrences in this line
};

/// Returns a finding as "program: line 7: message". Unknown parts are omitted.
std::string text_of(const Finding& finding);

/// Collects findings. Findings of the same kind and line are merged into one finding, which contains the worst value
/// and the number of occurrences.
class FindingList {
 public:
  /// Sets the program to which the following findings belong.
  void begin(std::string program) { program_ = std::move(program); }
  void add(std::string kind, std::int32_t line, std::string message, double value = 0.0, double limit = 0.0,
           std::int64_t element = -1) {
    add({std::move(kind), program_, line, element, std::move(message), value, limit, 1});
  }
  void add(Finding finding);
  bool empty() const { return findings_.empty(); }
  /// Returns the findings, sorted by program and line.
  std::vector<Finding> take();

 private:
  std::string program_;
  std::map<std::tuple<std::string, std::int32_t, std::string>, Finding> findings_;
};

}  // namespace retrace::fabrication
