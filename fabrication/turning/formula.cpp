#include "fabrication/turning/formula.h"

#include <fmt/format.h>
#include <muParser.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/message_text.h"

namespace retrace::fabrication::turning {
namespace {

using Step = Formula::Step;

/// muParser reads, and this writes down what it would compute: its values are indices of nodes. Thus the grammar is
/// the library's and the derivatives, which it has none of, are ours.
struct Recorder {
  std::vector<Formula::Node> nodes;

  double add(Step step, double a = 0.0, double b = 0.0, double number = 0.0) {
    nodes.push_back({step, static_cast<int>(a), static_cast<int>(b), number});
    return static_cast<double>(nodes.size() - 1);
  }
};

/// Callbacks of the library's operators take no data of ours.
thread_local Recorder* recorder = nullptr;

template <Step step>
double unary(double a) {
  return recorder->add(step, a);
}
template <Step step>
double binary(double a, double b) {
  return recorder->add(step, a, b);
}
double same(double a) {
  return a;
}

/// A number at the front of `text`: recorded, and skipped.
int number_at(const char* text, int* position, double* value) {
  if (*text != '.' && std::isdigit(static_cast<unsigned char>(*text)) == 0) return 0;
  const std::string_view rest(text);
  double number = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{}) return 0;
  *position += static_cast<int>(end - rest.data());
  *value = recorder->add(Step::constant, 0.0, 0.0, number);
  return 1;
}

void set_grammar(mu::Parser& parser) {
  parser.EnableBuiltInOprt(false);
  parser.EnableOptimizer(false);
  parser.ClearConst();
  parser.ClearFun();
  parser.ClearInfixOprt();
  parser.AddValIdent(number_at);
  parser.DefineOprt("+", binary<Step::add>, mu::prADD_SUB, mu::oaLEFT, false);
  parser.DefineOprt("-", binary<Step::subtract>, mu::prADD_SUB, mu::oaLEFT, false);
  parser.DefineOprt("*", binary<Step::multiply>, mu::prMUL_DIV, mu::oaLEFT, false);
  parser.DefineOprt("/", binary<Step::divide>, mu::prMUL_DIV, mu::oaLEFT, false);
  parser.DefineOprt("^", binary<Step::power>, mu::prPOW, mu::oaRIGHT, false);
  // -x^2 is -(x^2): the sign binds as a product does.
  parser.DefineInfixOprt("-", unary<Step::negate>, mu::prMUL_DIV, false);
  parser.DefineInfixOprt("+", same, mu::prMUL_DIV, false);
  parser.DefineFun("sqrt", unary<Step::sqrt>, false);
  parser.DefineFun("exp", unary<Step::exp>, false);
  parser.DefineFun("log", unary<Step::log>, false);
  parser.DefineFun("sin", unary<Step::sin>, false);
  parser.DefineFun("cos", unary<Step::cos>, false);
  parser.DefineFun("tan", unary<Step::tan>, false);
  parser.DefineFun("asin", unary<Step::asin>, false);
  parser.DefineFun("acos", unary<Step::acos>, false);
  parser.DefineFun("atan", unary<Step::atan>, false);
  parser.DefineFun("sinh", unary<Step::sinh>, false);
  parser.DefineFun("cosh", unary<Step::cosh>, false);
  parser.DefineFun("tanh", unary<Step::tanh>, false);
  parser.DefineFun("abs", unary<Step::abs>, false);
  parser.DefineFun("atan2", binary<Step::atan2>, false);
}

template <class T>
T absolute(const T& a) {
  return value_of(a) < 0.0 ? -a : a;
}

template <class T>
T arc_tangent(const T& y) {
  using std::atan2;
  return atan2(y, constant_like(y, 1.0));
}

template <class T>
T hyperbolic_sine(const T& a) {
  using std::exp;
  return (exp(a) - exp(-a)) * 0.5;
}
template <class T>
T hyperbolic_cosine(const T& a) {
  using std::exp;
  return (exp(a) + exp(-a)) * 0.5;
}

/// Whole exponents are products, which also exist where the base is not positive.
template <class T>
T to_the_power(const T& a, const T& b, const Formula::Node& exponent) {
  using std::exp;
  using std::log;
  if (exponent.step == Step::constant) {
    const double e = exponent.number;
    if (e == std::floor(e) && std::abs(e) <= 64.0) {
      const T positive = power(a, static_cast<int>(std::abs(e)));
      return e < 0.0 ? constant_like(a, 1.0) / positive : positive;
    }
  }
  return exp(b * log(a));
}

template <class T>
T one_step(const Formula::Node& node, const std::vector<T>& v, const T* variables,
           const std::vector<Formula::Node>& nodes) {
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  if (node.step == Step::constant) return constant_like(variables[0], node.number);
  if (node.step == Step::variable) return variables[node.a];
  const T& a = v[index(node.a)];
  const T& b = v[index(node.b)];
  const T one = constant_like(a, 1.0);
  switch (node.step) {
    case Step::add:
      return a + b;
    case Step::subtract:
      return a - b;
    case Step::multiply:
      return a * b;
    case Step::divide:
      return a / b;
    case Step::negate:
      return -a;
    case Step::power:
      return to_the_power(a, b, nodes[index(node.b)]);
    case Step::sqrt:
      return sqrt(a);
    case Step::exp:
      return exp(a);
    case Step::log:
      return log(a);
    case Step::sin:
      return sin(a);
    case Step::cos:
      return cos(a);
    case Step::tan:
      return sin(a) / cos(a);
    case Step::asin:
      return atan2(a, sqrt(one - a * a));
    case Step::acos:
      return atan2(sqrt(one - a * a), a);
    case Step::atan:
      return arc_tangent(a);
    case Step::atan2:
      return atan2(a, b);
    case Step::sinh:
      return hyperbolic_sine(a);
    case Step::cosh:
      return hyperbolic_cosine(a);
    case Step::tanh:
      return hyperbolic_sine(a) / hyperbolic_cosine(a);
    case Step::abs:
      return absolute(a);
    case Step::constant:
    case Step::variable:
      break;
  }
  return one;
}

}  // namespace

template <class T>
T Formula::evaluate(const T* variables) const {
  std::vector<T> values;
  values.reserve(nodes.size());
  for (const Node& node : nodes) values.push_back(one_step(node, values, variables, nodes));
  return values[static_cast<std::size_t>(result)];
}

template double Formula::evaluate(const double*) const;
template Dual Formula::evaluate(const Dual*) const;
template Jet2 Formula::evaluate(const Jet2*) const;
template Series<double> Formula::evaluate(const Series<double>*) const;
template Series<Dual> Formula::evaluate(const Series<Dual>*) const;
template Series<Jet2> Formula::evaluate(const Series<Jet2>*) const;
template Series<Series<double>> Formula::evaluate(const Series<Series<double>>*) const;
template Series<Series<Dual>> Formula::evaluate(const Series<Series<Dual>>*) const;
template Series<Series<Jet2>> Formula::evaluate(const Series<Series<Jet2>>*) const;
template Series<Series<Series<double>>> Formula::evaluate(const Series<Series<Series<double>>>*) const;
template Series<Jet2, 1> Formula::evaluate(const Series<Jet2, 1>*) const;
template Series<Jet2, 2> Formula::evaluate(const Series<Jet2, 2>*) const;
template Series<Jet2, 3> Formula::evaluate(const Series<Jet2, 3>*) const;
template Series<Jet2, 4> Formula::evaluate(const Series<Jet2, 4>*) const;

bool Formula::uses(int variable) const {
  std::vector<bool> is_used(nodes.size(), false);
  is_used[static_cast<std::size_t>(result)] = true;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!is_used[i]) continue;
    if (nodes[i].step == Step::variable && nodes[i].a == variable) return true;
    if (nodes[i].step == Step::variable || nodes[i].step == Step::constant) continue;
    is_used[static_cast<std::size_t>(nodes[i].a)] = true;
    is_used[static_cast<std::size_t>(nodes[i].b)] = true;
  }
  return false;
}

Formula parse_formula(const std::string& text, const std::vector<std::string>& variables, const InputLocation& where) {
  if (text.size() > kLongestFormula)
    throw InputError(where, fmt::format("must have at most {} characters, got {}", kLongestFormula, text.size()));
  // The library takes conditions whatever its operators are; they would have no derivatives.
  if (const std::size_t at = text.find_first_of("?:"); at != std::string::npos)
    throw InputError(where, fmt::format("does not parse at character {}: conditions are not allowed, got {}", at + 1,
                                        in_quotes(text)));
  Recorder record;
  recorder = &record;
  std::vector<double> handles;
  for (std::size_t i = 0; i < variables.size(); ++i)
    handles.push_back(record.add(Step::variable, static_cast<double>(i)));
  double pi = record.add(Step::constant, 0.0, 0.0, std::numbers::pi);
  Formula formula;
  formula.text = text;
  try {
    mu::Parser parser;
    set_grammar(parser);
    for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &handles[i]);
    parser.DefineVar("pi", &pi);
    parser.SetExpr(text);
    int results = 0;
    const double* const values = parser.Eval(results);
    if (results != 1) throw InputError(where, "must be one formula, got several: " + in_quotes(text));
    formula.result = static_cast<int>(values[0]);
  } catch (const mu::Parser::exception_type& error) {
    throw InputError(where, fmt::format("does not parse at character {}: {}, got {}", error.GetPos() + 1,
                                        printable(error.GetMsg(), 120), in_quotes(text)));
  }
  formula.nodes = std::move(record.nodes);
  return formula;
}

}  // namespace retrace::fabrication::turning
