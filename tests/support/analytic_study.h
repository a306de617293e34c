#pragma once

// Studies whose quantities are analytic functions, for tests of optimizations and compositions.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study.h"

namespace retrace::test {

/// Folder of the example studies.
inline const std::string kStudies = std::string(RETRACE_SOURCE_DIR) + "/examples/studies/";

/// A quantity that is a function of the thickness of the plate (x) and the refractive index behind the facets (y). It
/// replaces a traced quantity.
class Analytic : public studies::Quantity {
 public:
  using Function = std::function<double(double x, double y)>;
  Analytic(std::string name, Function f) : Quantity(std::move(name)), f_(std::move(f)) {}
  std::optional<studies::Measured> measure(const studies::Candidate& candidate, const Cancellation*) const override {
    return studies::Measured{f_(candidate.design().part().thickness_mm, candidate.design().substance.back_index), 0.0};
  }

 private:
  Function f_;
};

/// Names of quantities, and the functions that define them.
using Functions = std::vector<std::pair<std::string, Analytic::Function>>;

/// TOML text of the parameters: x, the thickness, from 0.5 to 3 mm, and y, the refractive index behind the facets, from
/// 1 to 3.
constexpr const char* kIntervals =
    "[[parameter]]\nkey = \"body.thickness_mm\"\nname = \"x\"\nfrom = 0.5\nto = 3\n"
    "[[parameter]]\nkey = \"body.back_index\"\nname = \"y\"\nfrom = 1\nto = 3\n";

/// Returns a study with analytic quantities.
/// \param keys TOML text of the tables of the study, without parameters and quantities
inline studies::Study analytic_study(const std::string& keys, const Functions& functions,
                                     const std::string& parameters = kIntervals) {
  std::string text = "design = \"../rtp_brick_1mm.toml\"\n" + parameters;
  for (const auto& [name, f] : functions) text += "[[quantity]]\nkind = \"elements_full\"\nname = \"" + name + "\"\n";
  studies::Study study = studies::parse_study(text + keys, kStudies + "study.toml");
  study.quantities.clear();
  for (const auto& [name, f] : functions) study.quantities.push_back(std::make_shared<Analytic>(name, f));
  return study;
}

}  // namespace retrace::test
