#pragma once

// What is found wrong with programs, of whatever process.

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace retrace::fabrication {

/// Something that a program does and should not, or does not and should.
struct Finding {
  std::string kind;           ///< such as "gouge"; docs/commands.md lists them
  std::string program;        ///< file; empty: of none, or of all together
  std::int32_t line = 0;      ///< of the NC text; 0: of no line
  std::int64_t element = -1;  ///< -1: of none
  std::string message;
  double value = 0.0;  ///< in the unit that the message names
  double limit = 0.0;
  std::int64_t count = 1;  ///< how often this line does it
};

/// "program: line 7: message", without what is not known.
std::string text_of(const Finding& finding);

/// Collects findings: one for each kind and line, with the worst value and how often it came up.
class FindingList {
 public:
  /// What is added without a program comes from that one.
  void begin(std::string program) { program_ = std::move(program); }
  void add(std::string kind, std::int32_t line, std::string message, double value = 0.0, double limit = 0.0,
           std::int64_t element = -1) {
    add({std::move(kind), program_, line, element, std::move(message), value, limit, 1});
  }
  void add(Finding finding);
  bool empty() const { return findings_.empty(); }
  /// In the order of programs and lines.
  std::vector<Finding> take();

 private:
  std::string program_;
  std::map<std::tuple<std::string, std::int32_t, std::string>, Finding> findings_;
};

}  // namespace retrace::fabrication
