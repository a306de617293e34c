#pragma once

// Names that tell the designs of a result folder apart.

#include <map>
#include <string>

#include "report/page/result_folder.h"

namespace retrace::report {

/// Returns the design that a number in a document refers to; null if no document of its folder quotes the design.
/// Footprints and far fields refer to the designs of the efficiency next to them.
const nlohmann::ordered_json* design_of(const ResultFolder& folder, const ResultDocument& document, double number);

/// A name for each design of a folder. Different designs have different names.
class DesignNames {
 public:
  explicit DesignNames(const ResultFolder& folder);

  bool are_several() const { return names_.size() > 1; }
  std::size_t count() const { return names_.size(); }
  /// Returns the name of a design that a document of the folder quotes.
  std::string of(const nlohmann::ordered_json& design) const;
  /// Returns the name of the design that a number in a document refers to, or "design 3".
  std::string of(const ResultDocument& document, double number) const;

 private:
  const ResultFolder& folder_;
  std::map<std::string, std::string> names_;  ///< of contents
};

}  // namespace retrace::report
