#pragma once

// Output documents and tables of `retrace optimize`.

#include <string>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.optimum/1`.
std::string optimum_json(const Study& study, const OptimiseRequest& request, const Optimum& optimum, double elapsed_s);

/// Returns the Pareto front as CSV, with one line for each design.
std::string front_csv(const Study& study, const Optimum& optimum);

/// Returns all evaluated designs as CSV, one line per design. The columns contain the parameters, the quantities with
/// their standard errors, and the objective. The last two columns state whether the design satisfies all constraints,
/// and the reason if it does not.
std::string designs_csv(const Study& study, const Optimum& optimum);

/// Returns the text of a design file for an evaluated design.
/// \param comment text of the comment lines at the beginning of the file
/// \throw InputError if the design is invalid
std::string variant_design_text(const Study& study, const Variant& variant, const std::string& comment);

/// Returns the objective and the parameters of a design in one short line, such as "rre = 0.9538 at size_mm = 1".
std::string short_text(const Study& study, const OptimiseRequest& request, const Variant& variant);

/// Returns the chosen design, its alternatives and its tolerance bands for the terminal.
std::string optimum_text(const Study& study, const OptimiseRequest& request, const Optimum& optimum);

}  // namespace retrace::studies
