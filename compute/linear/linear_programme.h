#pragma once

// Solves linear programmes with bounds, and returns their optimum and dual prices. Only linear_programme.cpp uses the
// library GLPK.

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/progress.h"

namespace retrace::compute {

/// Interval from `lower` to `upper`. Missing limits are infinite.
struct Bounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Linear programme. Columns are the unknowns, and rows are weighted sums of the unknowns. Columns and rows have
/// bounds. The objective function is the sum, over all columns, of Column::objective times the unknown. It is
/// maximized.
class LinearProgramme {
 public:
  /// Index of a column, and the weight of its value in a row.
  using Term = std::pair<std::size_t, double>;
  struct Column {
    Bounds bounds;
    double objective = 0.0;
  };
  struct Row {
    Bounds bounds;
    std::vector<Term> terms;
  };

  /// Adds a column.
  /// \return index of the column
  /// \pre all numbers are finite except for infinite bounds, and lower <= upper
  std::size_t add_column(const Bounds& bounds, double objective);
  /// Adds a row.
  /// \return index of the row
  /// \pre the numbers meet the conditions of add_column(); every column in `terms` exists, and no column occurs in more
  /// than one term
  std::size_t add_row(const Bounds& bounds, std::vector<Term> terms);

  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

/// Result of a linear programme.
struct LinearOptimum {
  enum class Kind {
    optimal,     ///< the values are feasible and the objective is maximal
    infeasible,  ///< no values satisfy all rows and bounds
    unbounded,
    interrupted
  };
  Kind kind = Kind::infeasible;
  double objective = 0.0;
  std::vector<double> values;  ///< values of the columns
  /// Dual prices of the rows: increase of the objective per unit of the active bound, or 0 if no bound is active. If
  /// the programme is infeasible, these are Farkas multipliers whose absolute values add up to 1. The sum of all rows,
  /// each times its multiplier, is then a constraint that no values within the bounds of the columns satisfy.
  std::vector<double> prices;
  /// Reduced costs of the columns: Column::objective minus the sum, over all rows, of price times weight of the column.
  std::vector<double> reduced_costs;
};

/// Solves a linear programme with a relative accuracy of about 1e-12. The result is deterministic.
/// \param cancel cancellation, which is checked several times per second; may be null
/// \throw BudgetError if the coefficients differ too much in size for a reliable result
LinearOptimum solve(const LinearProgramme& programme, const Cancellation* cancel = nullptr);

}  // namespace retrace::compute
