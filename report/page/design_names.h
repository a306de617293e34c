#pragma once

// Distinct names for the designs of a result folder.

#include <map>
#include <string>

#include "report/page/result_folder.h"

namespace retrace::report {

/// Returns the design with the index `number` in the list of designs of a document. Footprints and far fields have no
/// such list; for them, the list of the efficiency document in the same folder is used. Returns null if the design is
/// not found.
const nlohmann::ordered_json* design_of(const ResultFolder& folder, const ResultDocument& document, double number);

/// A name for each design of a folder. Different designs have different names.
class DesignNames {
 public:
  explicit DesignNames(const ResultFolder& folder);

  bool are_several() const { return names_.size() > 1; }
  std::size_t count() const { return names_.size(); }
  /// Returns the name of a design that a document of the folder contains.
  std::string of(const nlohmann::ordered_json& design) const;
  /// Returns the name of the design with the index `number`, see design_of(). If the design is not found, returns
  /// "design" and the number.
  std::string of(const ResultDocument& document, double number) const;

 private:
  const ResultFolder& folder_;
  std::map<std::string, std::string> names_;  ///< names by the JSON content of the design
};

}  // namespace retrace::report
