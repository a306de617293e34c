#include "core/math/formula.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <string_view>

#include "core/leading_number.h"
#include "core/math/formula_error.h"
#include "core/math/formula_evaluation.h"
#include "core/message_text.h"

namespace retrace {
namespace {

using Step = Formula::Step;

/// Records the operations of a formula as nodes while muParser evaluates the formula. During this evaluation, each
/// value is the index of a node instead of a number, so muParser only determines the order of the operations.
/// Derivatives, which muParser does not support, are computed from the nodes.
struct Recorder {
  std::vector<Formula::Node> nodes;

  double add(Step step, double a = 0.0, double b = 0.0, double number = 0.0) {
    nodes.push_back({step, static_cast<int>(a), static_cast<int>(b), number});
    return static_cast<double>(nodes.size() - 1);
  }
};

/// Recorder of the formula that is being parsed. It is global because the callbacks of muParser's operators have no
/// parameter for user data.
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

/// Callback of muParser that reads a number at the beginning of `text` and records it as a constant.
/// \return 1 if there is a number, which is then skipped; 0 otherwise
int number_at(const char* text, int* position, double* value) {
  if (*text != '.' && std::isdigit(static_cast<unsigned char>(*text)) == 0) return 0;
  const std::string_view rest(text);
  const std::optional<LeadingNumber> number = leading_number(rest);
  // muParser must not read the number itself, because its value would be used as the index of a node.
  if (!number) throw mu::Parser::exception_type("a number too large or too small");
  *position += static_cast<int>(number->length);
  *value = recorder->add(Step::constant, 0.0, 0.0, number->value);
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
  // -x^2 is -(x^2): the sign has the precedence of a product.
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

/// Evaluates constant subexpressions and removes nodes that the result does not need.
std::vector<Formula::Node> simplified(std::vector<Formula::Node> nodes, std::size_t result) {
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  const auto is_leaf = [](const Formula::Node& n) { return n.step == Step::constant || n.step == Step::variable; };
  std::vector<bool> is_needed(nodes.size(), false);
  for (Formula::Node& node : nodes) {
    if (is_leaf(node)) continue;
    const Formula::Node& a = nodes[index(node.a)];
    const Formula::Node& b = is_binary(node.step) ? nodes[index(node.b)] : a;
    if (a.step != Step::constant || b.step != Step::constant) continue;
    const Formula alone{"", {a, b, {node.step, 0, 1, 0.0}}};
    const double none = 0.0;
    node = {Step::constant, 0, 0, alone.evaluate(&none)};
  }
  is_needed[result] = true;
  for (std::size_t i = result + 1; i-- > 0;) {
    if (!is_needed[i] || is_leaf(nodes[i])) continue;
    is_needed[index(nodes[i].a)] = true;
    if (is_binary(nodes[i].step)) is_needed[index(nodes[i].b)] = true;
  }
  std::vector<Formula::Node> kept;
  std::vector<int> place(nodes.size(), 0);
  for (std::size_t i = 0; i <= result; ++i) {
    if (!is_needed[i]) continue;
    place[i] = static_cast<int>(kept.size());
    Formula::Node node = nodes[i];
    if (!is_leaf(node)) {
      node.a = place[index(node.a)];
      node.b = is_binary(node.step) ? place[index(node.b)] : 0;
    }
    kept.push_back(node);
  }
  return kept;
}

/// Returns a message of muParser as part of a sentence. Removes the position at its end, because muParser counts
/// characters from 0.
std::string reason_of(std::string message) {
  for (const std::string_view mark : {" found at position ", " at expression position ", " at position "})
    if (const std::size_t at = message.rfind(mark);
        at != std::string::npos && message.find_first_not_of("0123456789.", at + mark.size()) == std::string::npos) {
      message.resize(at);
      break;
    }
  while (message.ends_with('.') || message.ends_with('!')) message.pop_back();
  if (!message.empty()) message[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(message[0])));
  return message;
}

}  // namespace

Formula parse_formula(const std::string& text, const std::vector<std::string>& variables, const InputLocation& where) {
  if (text.size() > kMaxFormulaLength)
    throw InputError(where, fmt::format("must have at most {} characters, got {}", kMaxFormulaLength, text.size()));
  const auto failed_at = [&](std::size_t position, const std::string& reason) {
    return FormulaError(
        where,
        fmt::format("must be a valid formula; error at character {}: {}, got {}", position, reason, in_quotes(text)),
        position);
  };
  if (const auto at =
          std::find_if(text.begin(), text.end(),
                       [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0 && c != '\t'; });
      at != text.end())
    throw failed_at(static_cast<std::size_t>(at - text.begin()) + 1, "control characters are not allowed");
  // muParser always accepts conditions (a ? b : c). They cannot be differentiated here and are refused.
  if (const std::size_t at = text.find_first_of("?:"); at != std::string::npos)
    throw failed_at(at + 1, "conditions are not allowed");
  Recorder record;
  recorder = &record;
  std::vector<double> handles;
  for (std::size_t i = 0; i < variables.size(); ++i)
    handles.push_back(record.add(Step::variable, static_cast<double>(i)));
  double pi = record.add(Step::constant, 0.0, 0.0, std::numbers::pi);
  std::size_t result = 0;
  try {
    mu::Parser parser;
    set_grammar(parser);
    for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &handles[i]);
    parser.DefineVar("pi", &pi);
    parser.SetExpr(text);
    int results = 0;
    const double* const values = parser.Eval(results);
    if (results != 1) throw InputError(where, "must be one formula, got several: " + in_quotes(text));
    result = static_cast<std::size_t>(values[0]);
  } catch (const mu::Parser::exception_type& error) {
    // For an error at the end of the text, muParser returns a position that is too large by one.
    throw failed_at(std::min(static_cast<std::size_t>(error.GetPos()), text.size()) + 1,
                    printable(reason_of(error.GetMsg()), 120));
  }
  return {text, simplified(std::move(record.nodes), result)};
}

}  // namespace retrace
