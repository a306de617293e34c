#pragma once

// Compares values that retrace computes with published values, closed forms and independent computations. `retrace
// validate` runs this study.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"

namespace retrace::studies {

/// Origin of an expected value.
enum class Reference {
  published,    ///< printed in a publication, as theory or as a measurement
  closed_form,  ///< from a formula that docs/theory derives; evaluated independently of the compared computation
  independent   ///< from a program or a formula that has nothing in common with the compared computation
};
inline constexpr std::string_view kReferenceWords[] = {"published", "closed_form", "independent"};

/// Expected value of one quantity, and the function with which retrace computes the quantity.
struct ValidationRow {
  std::string topic = {};  ///< topic; rows with the same topic are adjacent
  std::string quantity = {};
  std::string unit = {};  ///< unit; empty if the quantity has none
  Reference reference = Reference::closed_form;
  double expected = 0.0;
  std::string source = {};  ///< publication, or section of docs/theory that derives the formula
  /// Maximum absolute difference with which the expected value counts as reproduced, >= 0. None if it is known that the
  /// value is not reproduced; it is then shown without a verdict.
  std::optional<double> allowed = 0.0;
  std::string why = {};  ///< cause of the allowed difference
  /// Function that computes the quantity, in `unit`. If the computation is cancelled, it may return any number.
  std::function<double(const Cancellation*)> compute = {};
};

/// Row with its computed value.
struct ValidatedRow {
  ValidationRow row;
  double computed = 0.0;

  double difference() const { return computed - row.expected; }
  /// Returns true if the difference is allowed. Returns nothing if the row has no allowed difference.
  std::optional<bool> holds() const;
};

struct ValidationResult {
  std::vector<ValidatedRow> rows;  ///< computed rows, in the order in which they were requested
  std::size_t requested = 0;
  double elapsed_s = 0.0;
  bool complete = true;  ///< false if the validation was cancelled

  /// Returns true if no row has a difference larger than allowed.
  bool holds() const;
};

/// Returns all rows of the validation, ordered by topic.
std::vector<ValidationRow> validation_rows();

/// Computes rows in parallel, in the TBB arena of the calling thread.
/// \throw Error of the computation of a row
ValidationResult validate(const std::vector<ValidationRow>& rows, Progress* progress = nullptr,
                          const Cancellation* cancel = nullptr);

}  // namespace retrace::studies
