#include "studies/validation/validation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "core/threads.h"
#include "studies/validation/rows.h"

namespace retrace::studies {

std::optional<bool> ValidatedRow::holds() const {
  if (!row.allowed) return std::nullopt;
  return std::abs(difference()) <= *row.allowed;  // false if the computed value is NaN
}

bool ValidationResult::holds() const {
  return std::all_of(rows.begin(), rows.end(), [](const ValidatedRow& row) { return row.holds().value_or(true); });
}

std::vector<ValidationRow> validation_rows() {
  std::vector<ValidationRow> all;
  for (const auto rows : {light_validation, ball_validation, ranging_validation, surface_validation, chisel_validation,
                          force_validation, turning_validation})
    for (ValidationRow& row : rows()) all.push_back(std::move(row));
  return all;
}

ValidationResult validate(const std::vector<ValidationRow>& rows, Progress* progress, const Cancellation* cancel) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::optional<double>> computed(rows.size());
  std::mutex told;
  std::size_t done = 0;
  for_each_in_parallel(rows.size(), [&](std::size_t k) {
    if (is_cancelled(cancel)) return;
    const double value = rows[k].compute(cancel);
    if (is_cancelled(cancel)) return;
    computed[k] = value;
    const std::lock_guard lock(told);
    ++done;
    if (progress != nullptr) progress->at(static_cast<double>(done) / static_cast<double>(rows.size()));
  });
  ValidationResult result;
  result.requested = rows.size();
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (computed[k]) result.rows.push_back({rows[k], *computed[k]});
  result.complete = result.rows.size() == rows.size();
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
