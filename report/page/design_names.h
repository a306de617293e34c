#pragma once

// Unique names for the designs in a result folder.

#include <map>
#include <string>

#include "design/io/design_labels.h"
#include "report/page/result_folder.h"

namespace retrace::report {

/// Returns the design with index `number` in the list `designs` of a document, or null if there is no such design.
/// Footprint and far-field documents have no list of designs. For these, the list in the efficiency document of the
/// same folder is used.
const nlohmann::ordered_json* design_of(const ResultFolder& folder, const ResultDocument& document, double number);

/// Unique names for all designs in a folder, see design::design_labels(). Equal designs have the same name. Documents
/// with several designs have names of their own, which distinguish these designs.
class DesignNames {
 public:
  explicit DesignNames(const ResultFolder& folder);

  bool are_several() const { return names_.size() > 1; }
  /// Returns true if the folder contains several different designs. Also returns true if the document contains several
  /// designs, which may be equal.
  bool are_several(const ResultDocument& document) const { return are_several() || labels_of(document) != nullptr; }
  std::size_t count() const { return names_.size(); }
  /// Returns the name of a design.
  /// \param design JSON object of the design in a document of the folder
  std::string of(const nlohmann::ordered_json& design) const;
  /// Returns the name of the design with index `number` in a document, see design_of(). Equal designs of one document
  /// have different names. If there is no such design, returns "design" followed by the number.
  std::string of(const ResultDocument& document, double number) const;
  /// Returns the labels of the designs of a document, or null if it does not have several designs.
  const design::DesignLabels* labels_of(const ResultDocument& document) const;

 private:
  const ResultFolder& folder_;
  std::map<std::string, std::string> names_;            ///< key: JSON text of a design; value: its unique name
  std::map<std::string, design::DesignLabels> labels_;  ///< by the name of a document with several designs
};

}  // namespace retrace::report
