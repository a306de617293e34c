#pragma once

// Linear programmes with bounds, and what their optimum and its prices are. GLPK stays behind this file.

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/progress.h"

namespace retrace::studies {

/// From `least` to `most`; infinite where there is no end.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// Columns, the values that are sought, and rows, weighted sums of them, each within its bounds. The sum of objective
/// times value over the columns is to be as large as it can be.
class LinearProgramme {
 public:
  /// A column and the factor of its value in a row.
  using Term = std::pair<std::size_t, double>;
  struct Column {
    Bounds bounds;
    double objective = 0.0;
  };
  struct Row {
    Bounds bounds;
    std::vector<Term> terms;
  };

  /// \return its number \pre finite numbers but for infinite bounds, least <= most
  std::size_t add_column(const Bounds& bounds, double objective);
  /// \return its number \pre likewise; the columns are there, each at most once
  std::size_t add_row(const Bounds& bounds, std::vector<Term> terms);

  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

/// What became of a linear programme.
struct LinearOptimum {
  enum class Kind {
    optimal,     ///< nothing is better
    infeasible,  ///< nothing holds all rows and bounds
    unbounded,
    interrupted
  };
  Kind kind = Kind::infeasible;
  double objective = 0.0;
  std::vector<double> values;  ///< of the columns
  /// Of the rows: how much larger the objective is for one more of the bound that the row touches, 0 where it touches
  /// none. Infeasible: Farkas's multipliers, whose absolute values add to 1: each row times its multiplier, added up,
  /// is a row that no values within the bounds of the columns hold.
  std::vector<double> prices;
  std::vector<double> reduced_costs;  ///< of the columns, likewise: objective less what the rows' prices make of it
};

/// The optimum, to some 1e-12 of the numbers in it; deterministic. \param cancel is asked some times a second
/// \throw BudgetError if the numbers are such that it cannot be told
LinearOptimum solve(const LinearProgramme& programme, const Cancellation* cancel = nullptr);

}  // namespace retrace::studies
