#pragma once

// Unique names for the designs in a result folder.

#include <map>
#include <string>

#include "report/page/result_folder.h"

namespace retrace::report {

/// Returns the design with index `number` in the list `designs` of a document, or null if there is no such design.
/// Footprint and far-field documents have no list of designs. For these, the list in the efficiency document of the
/// same folder is used.
const nlohmann::ordered_json* design_of(const ResultFolder& folder, const ResultDocument& document, double number);

/// Unique names for all designs in a folder. Equal designs have the same name.
class DesignNames {
 public:
  explicit DesignNames(const ResultFolder& folder);

  bool are_several() const { return names_.size() > 1; }
  std::size_t count() const { return names_.size(); }
  /// Returns the name of a design.
  /// \param design JSON object of the design in a document of the folder
  std::string of(const nlohmann::ordered_json& design) const;
  /// Returns the name of the design with index `number` in a document, see design_of(). If there is no such design,
  /// returns "design" followed by the number.
  std::string of(const ResultDocument& document, double number) const;

 private:
  const ResultFolder& folder_;
  std::map<std::string, std::string> names_;  ///< key: JSON text of a design; value: its unique name
};

}  // namespace retrace::report
