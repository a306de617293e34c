#include "compute/linear/linear_programme.h"

#include <glpk.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"

namespace retrace::compute {
namespace {

struct ProblemDeleter {
  void operator()(glp_prob* problem) const { glp_delete_prob(problem); }
};
using Problem = std::unique_ptr<glp_prob, ProblemDeleter>;

/// Returns the GLPK constant for the type of the bounds.
int type_of(const Bounds& bounds) {
  const bool has_least = std::isfinite(bounds.lower);
  const bool has_most = std::isfinite(bounds.upper);
  if (has_least && has_most) return bounds.lower == bounds.upper ? GLP_FX : GLP_DB;
  if (has_least) return GLP_LO;
  return has_most ? GLP_UP : GLP_FR;
}

/// Returns the number of a row or column in GLPK. GLPK counts rows and columns from 1.
int number_of(std::size_t index) {
  return static_cast<int>(index) + 1;
}

Problem problem_of(const LinearProgramme& programme) {
  Problem problem(glp_create_prob());
  glp_set_obj_dir(problem.get(), GLP_MAX);
  if (!programme.columns().empty()) glp_add_cols(problem.get(), static_cast<int>(programme.columns().size()));
  if (!programme.rows().empty()) glp_add_rows(problem.get(), static_cast<int>(programme.rows().size()));
  for (std::size_t k = 0; k < programme.columns().size(); ++k) {
    const LinearProgramme::Column& column = programme.columns()[k];
    glp_set_col_bnds(problem.get(), number_of(k), type_of(column.bounds), column.bounds.lower, column.bounds.upper);
    glp_set_obj_coef(problem.get(), number_of(k), column.objective);
  }
  for (std::size_t k = 0; k < programme.rows().size(); ++k) {
    const LinearProgramme::Row& row = programme.rows()[k];
    glp_set_row_bnds(problem.get(), number_of(k), type_of(row.bounds), row.bounds.lower, row.bounds.upper);
    std::vector<int> columns = {0};
    std::vector<double> factors = {0.0};
    for (const auto& [column, factor] : row.terms) {
      if (factor == 0.0) continue;
      columns.push_back(number_of(column));
      factors.push_back(factor);
    }
    glp_set_mat_row(problem.get(), number_of(k), static_cast<int>(columns.size()) - 1, columns.data(), factors.data());
  }
  return problem;
}

/// Turns off the terminal output of GLPK during the lifetime of the object.
class OutputSuppressor {
 public:
  OutputSuppressor() : before_(glp_term_out(GLP_OFF)) {}
  ~OutputSuppressor() { glp_term_out(before_); }
  OutputSuppressor(const OutputSuppressor&) = delete;
  OutputSuppressor& operator=(const OutputSuppressor&) = delete;

 private:
  int before_;
};

[[noreturn]] void refuse() {
  throw BudgetError("the linear programme cannot be solved: its coefficients differ by too many orders of magnitude");
}

constexpr int kCancelled = 0;

/// Solves the problem with the dual simplex method, in time slices between which `cancel` is checked. If the dual
/// method finds no optimum, or if its basis is almost singular, the primal method is used. The primal method determines
/// why there is no optimum.
/// \return status of the solution in GLPK, or kCancelled
int run_simplex(glp_prob* problem, const Cancellation* cancel) {
  constexpr int kSliceMs = 200;
  glp_smcp settings;
  glp_init_smcp(&settings);
  settings.msg_lev = GLP_MSG_OFF;
  settings.meth = GLP_DUALP;
  settings.tol_bnd = settings.tol_dj = 1e-9;
  settings.tm_lim = kSliceMs;
  for (;;) {
    const int code = glp_simplex(problem, &settings);
    if (is_cancelled(cancel)) return kCancelled;
    if (code == GLP_ETMLIM) continue;
    const bool is_last = settings.meth == GLP_PRIMAL;
    if (code == 0 && (is_last || glp_get_status(problem) == GLP_OPT)) return glp_get_status(problem);
    if (is_last) refuse();
    if (code != 0) glp_adv_basis(problem, 0);
    settings.meth = GLP_PRIMAL;
  }
}

void take_values(glp_prob* problem, const LinearProgramme& programme, LinearOptimum& optimum) {
  optimum.objective = glp_get_obj_val(problem);
  for (std::size_t k = 0; k < programme.columns().size(); ++k) {
    optimum.values.push_back(glp_get_col_prim(problem, number_of(k)));
    optimum.reduced_costs.push_back(glp_get_col_dual(problem, number_of(k)));
  }
  for (std::size_t k = 0; k < programme.rows().size(); ++k)
    optimum.prices.push_back(glp_get_row_dual(problem, number_of(k)));
}

/// Returns the Farkas multipliers of an infeasible programme. They are the dual prices of an elastic programme, which
/// allows violations of rows and minimizes the sum of the violations. The result is empty if the programme is feasible
/// or the elastic programme cannot be solved.
std::vector<double> certificate(const LinearProgramme& programme, const Cancellation* cancel) {
  LinearProgramme elastic;
  for (const LinearProgramme::Column& column : programme.columns()) elastic.add_column(column.bounds, 0.0);
  constexpr Bounds kNotNegative{.lower = 0.0};
  double size = 1e-300;
  for (const LinearProgramme::Row& row : programme.rows()) {
    std::vector<LinearProgramme::Term> terms = row.terms;
    terms.emplace_back(elastic.add_column(kNotNegative, -1.0), 1.0);
    terms.emplace_back(elastic.add_column(kNotNegative, -1.0), -1.0);
    elastic.add_row(row.bounds, std::move(terms));
    for (const double end : {row.bounds.lower, row.bounds.upper})
      if (std::isfinite(end)) size = std::max(size, std::abs(end));
  }
  const LinearOptimum least = solve(elastic, cancel);
  if (least.kind != LinearOptimum::Kind::optimal || least.objective > -1e-9 * size) return {};
  double sum = 0.0;
  for (const double price : least.prices) sum += std::abs(price);
  std::vector<double> multipliers;
  for (const double price : least.prices) multipliers.push_back(price / sum);
  return multipliers;
}

}  // namespace

std::size_t LinearProgramme::add_column(const Bounds& bounds, double objective) {
  columns_.push_back({bounds, objective});
  return columns_.size() - 1;
}

std::size_t LinearProgramme::add_row(const Bounds& bounds, std::vector<Term> terms) {
  rows_.push_back({bounds, std::move(terms)});
  return rows_.size() - 1;
}

LinearOptimum solve(const LinearProgramme& programme, const Cancellation* cancel) {
  const OutputSuppressor silence;
  const Problem problem = problem_of(programme);
  const int status = run_simplex(problem.get(), cancel);
  LinearOptimum optimum;
  if (status == kCancelled) {
    optimum.kind = LinearOptimum::Kind::interrupted;
  } else if (status == GLP_UNBND) {
    optimum.kind = LinearOptimum::Kind::unbounded;
  } else if (status == GLP_OPT) {
    optimum.kind = LinearOptimum::Kind::optimal;
    take_values(problem.get(), programme, optimum);
  } else {
    optimum.prices = certificate(programme, cancel);
    if (is_cancelled(cancel))
      optimum.kind = LinearOptimum::Kind::interrupted;
    else if (optimum.prices.empty())
      refuse();
  }
  return optimum;
}

}  // namespace retrace::compute
