#pragma once

// Figures that others have published, closed forms and independent computations, each held against what retrace
// computes. The study behind `retrace validate`.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"

namespace retrace::studies {

/// What a figure is that retrace is held against.
enum class Reference {
  published,    ///< printed in a publication, as theory or as a measurement
  closed_form,  ///< a formula that docs/theory derives, evaluated apart from what is held against it
  independent   ///< by a program or a formula that shares nothing with what is held against it
};
inline constexpr std::string_view kReferenceWords[] = {"published", "closed_form", "independent"};

/// One figure, and how retrace computes it.
struct ValidationRow {
  std::string topic = {};  ///< rows of one topic follow each other
  std::string quantity = {};
  std::string unit = {};  ///< empty: none
  Reference reference = Reference::closed_form;
  double expected = 0.0;
  std::string source = {};  ///< a publication, or where docs/theory derives the formula
  /// Largest |difference| that counts as reproduced, >= 0; none: the figure is known not to be reproduced, and shown
  /// without a verdict.
  std::optional<double> allowed = 0.0;
  std::string why = {};  ///< what that difference comes from
  /// The figure as retrace computes it, in `unit`. Once it is cancelled any number will do.
  std::function<double(const Cancellation*)> compute = {};
};

/// A row that was computed.
struct ValidatedRow {
  ValidationRow row;
  double computed = 0.0;

  double difference() const { return computed - row.expected; }
  /// Whether the difference is allowed; none where none is.
  std::optional<bool> holds() const;
};

struct ValidationResult {
  std::vector<ValidatedRow> rows;  ///< those that were computed, in the order given
  std::size_t requested = 0;
  double elapsed_s = 0.0;
  bool complete = true;  ///< false if it was cancelled

  /// Whether no row lies outside of what it is allowed.
  bool holds() const;
};

/// Every figure that retrace is held against, topic by topic.
std::vector<ValidationRow> validation_rows();

/// Computes rows at the same time, in the calling thread's TBB arena. \throw Error what a row's computation throws
ValidationResult validate(const std::vector<ValidationRow>& rows, Progress* progress = nullptr,
                          const Cancellation* cancel = nullptr);

}  // namespace retrace::studies
