#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace retrace::fabrication {

/// Something that a program does and should not, or does not and should.
struct Finding {
  std::string kind;           ///< such as "gouge"; docs/commands.md lists them
  std::string program;        ///< file
  std::int32_t line = 0;      ///< of the NC text; 0: of no line
  std::int64_t element = -1;  ///< -1: of none
  std::string message;
  double value = 0.0;  ///< in the unit that the message names
  double limit = 0.0;
  std::int64_t count = 1;  ///< how often this line does it
};

/// Collects findings: one for each kind and line, with the worst value and how often it came up.
class FindingList {
 public:
  void add(Finding finding);
  bool empty() const { return findings_.empty(); }
  /// In the order of programs and lines.
  std::vector<Finding> take();

 private:
  std::map<std::tuple<std::string, std::int32_t, std::string>, Finding> findings_;
};

}  // namespace retrace::fabrication
