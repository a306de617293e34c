// For any text, the reader either returns a formula or throws an InputError of one line. A formula has the same value
// for every number type.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "core/math/formula_evaluation.h"
#include "tests/fuzz/one_line.h"

namespace {

bool differ(double a, double b) {
  return std::isfinite(a) && std::isfinite(b) && std::abs(a - b) > 1e-6 * (std::abs(a) + std::abs(b)) + 1e-9;
}

void evaluate(const retrace::Formula& formula) {
  using namespace retrace::jets;
  const std::array<double, 2> numbers = {0.7, -1.3};
  const std::array<Gradient, 2> slopes = {Gradient(0.7, 1.0, 0.0), Gradient(-1.3, 0.0, 1.0)};
  const std::array<Series<double>, 2> series = {line_series(0.7, 1.0, 5), line_series(-1.3, 0.5, 5)};
  const double value = formula.evaluate(numbers.data());
  if (differ(value, formula.evaluate(slopes.data()).value) || differ(value, formula.evaluate(series.data())[0]))
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    evaluate(retrace::parse_formula(std::string(reinterpret_cast<const char*>(data), size), {"x", "y"}, {}));
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
