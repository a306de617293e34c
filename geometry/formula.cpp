#include "geometry/formula.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/message_text.h"

namespace retrace::geometry {
namespace {

/// f(a) by the chain rule, of which the value and two derivatives are given.
Jet chained(const Jet& a, double f, double f1, double f2) {
  return {f, f1 * a.x, f1 * a.y, f2 * a.x * a.x + f1 * a.xx, f2 * a.x * a.y + f1 * a.xy, f2 * a.y * a.y + f1 * a.yy};
}

Jet sum(const Jet& a, const Jet& b, double sign) {
  return {a.value + sign * b.value, a.x + sign * b.x,   a.y + sign * b.y,
          a.xx + sign * b.xx,       a.xy + sign * b.xy, a.yy + sign * b.yy};
}

Jet product(const Jet& a, const Jet& b) {
  return {a.value * b.value,
          a.x * b.value + a.value * b.x,
          a.y * b.value + a.value * b.y,
          a.xx * b.value + 2.0 * a.x * b.x + a.value * b.xx,
          a.xy * b.value + a.x * b.y + a.y * b.x + a.value * b.xy,
          a.yy * b.value + 2.0 * a.y * b.y + a.value * b.yy};
}

Jet logarithm(const Jet& a) {
  return chained(a, std::log(a.value), 1.0 / a.value, -1.0 / (a.value * a.value));
}

Jet exponential(const Jet& a) {
  const double e = std::exp(a.value);
  return chained(a, e, e, e);
}

bool is_constant(const Jet& a) {
  return a.x == 0.0 && a.y == 0.0 && a.xx == 0.0 && a.xy == 0.0 && a.yy == 0.0;
}

Jet power(const Jet& a, const Jet& b) {
  if (!is_constant(b)) return exponential(product(b, logarithm(a)));
  const double n = b.value;
  // 0 times a power that is infinite at 0 is 0: x^1 has no curvature.
  const auto term = [&](double factor, double exponent) {
    return factor == 0.0 ? 0.0 : factor * std::pow(a.value, exponent);
  };
  return chained(a, std::pow(a.value, n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0));
}

}  // namespace

bool Jet::is_finite() const {
  for (const double v : {value, x, y, xx, xy, yy})
    if (!std::isfinite(v)) return false;
  return true;
}

/// Recursive descent; a text of at most kMaxLength characters cannot nest deeper than the stack allows.
class FormulaParser {
 public:
  using Op = Formula::Op;

  FormulaParser(std::string_view text, std::vector<Formula::Step>& steps) : text_(text), steps_(steps) {}

  void parse() {
    expression();
    if (next() != '\0') fail("an operator");
  }

 private:
  char next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }

  [[noreturn]] void fail(std::string_view wanted) {
    const std::string found = next() == '\0' ? "its end" : in_quotes(text_.substr(at_, 12));
    throw InputError(fmt::format("is no formula of x and y: {} is missing at character {}, where {} stands", wanted,
                                 at_ + 1, found));
  }

  void emit(Op op, double number = 0.0) {
    steps_.push_back({op, number});
    const bool is_leaf = op == Op::number || op == Op::x || op == Op::y;
    const bool is_binary = op >= Op::add && op <= Op::power;
    depth_ += is_leaf ? 1 : is_binary ? -1 : 0;
    if (depth_ > static_cast<int>(Formula::kMaxDepth))
      throw InputError(fmt::format("is too deeply nested at character {}", at_ + 1));
  }

  void expression() {
    term();
    for (;;) {
      if (take('+')) {
        term();
        emit(Op::add);
      } else if (take('-')) {
        term();
        emit(Op::subtract);
      } else {
        return;
      }
    }
  }

  void term() {
    signed_factor();
    for (;;) {
      if (take('*')) {
        signed_factor();
        emit(Op::multiply);
      } else if (take('/')) {
        signed_factor();
        emit(Op::divide);
      } else {
        return;
      }
    }
  }

  void signed_factor() {
    if (take('-')) {
      signed_factor();
      emit(Op::negate);
    } else if (take('+')) {
      signed_factor();
    } else {
      factor();
    }
  }

  void factor() {
    primary();
    if (!take('^')) return;
    signed_factor();
    emit(Op::power);
  }

  void primary() {
    const char c = next();
    if (take('(')) {
      expression();
      if (!take(')')) fail("\")\"");
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      number();
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      name();
    } else {
      fail("a number, x, y or a function");
    }
  }

  void number() {
    double value = 0.0;
    const char* const first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error != std::errc{}) fail("a number");
    at_ += static_cast<std::size_t>(end - first);
    emit(Op::number, value);
  }

  void name() {
    static constexpr std::array<std::pair<std::string_view, Op>, 13> kFunctions = {{{"sqrt", Op::sqrt},
                                                                                    {"exp", Op::exp},
                                                                                    {"log", Op::log},
                                                                                    {"sin", Op::sin},
                                                                                    {"cos", Op::cos},
                                                                                    {"tan", Op::tan},
                                                                                    {"asin", Op::asin},
                                                                                    {"acos", Op::acos},
                                                                                    {"atan", Op::atan},
                                                                                    {"sinh", Op::sinh},
                                                                                    {"cosh", Op::cosh},
                                                                                    {"tanh", Op::tanh},
                                                                                    {"abs", Op::abs}}};
    std::size_t length = 0;
    while (at_ + length < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_ + length])) != 0) ++length;
    const std::string_view word = text_.substr(at_, length);
    if (word == "x" || word == "y" || word == "pi") {
      at_ += length;
      return word == "x" ? emit(Op::x) : word == "y" ? emit(Op::y) : emit(Op::number, std::numbers::pi);
    }
    for (const auto& [known, op] : kFunctions) {
      if (word != known) continue;
      at_ += length;
      if (!take('(')) fail("\"(\"");
      expression();
      if (!take(')')) fail("\")\"");
      return emit(op);
    }
    fail("x, y, pi or a function (sqrt, exp, log, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, abs)");
  }

  std::string_view text_;
  std::vector<Formula::Step>& steps_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

Formula::Formula(std::string_view text) : text_(text) {
  if (text.size() > kMaxLength)
    throw InputError(fmt::format("must have at most {} characters, got {}", kMaxLength, text.size()));
  FormulaParser(text_, steps_).parse();
}

Jet Formula::apply(Op op, const Jet& a) {
  const double v = a.value;
  switch (op) {
    case Op::negate:
      return chained(a, -v, -1.0, 0.0);
    case Op::sqrt: {
      const double root = std::sqrt(v);
      return chained(a, root, 0.5 / root, -0.25 / (v * root));
    }
    case Op::exp:
      return exponential(a);
    case Op::log:
      return logarithm(a);
    case Op::sin:
      return chained(a, std::sin(v), std::cos(v), -std::sin(v));
    case Op::cos:
      return chained(a, std::cos(v), -std::sin(v), -std::cos(v));
    case Op::tan: {
      const double t = std::tan(v);
      return chained(a, t, 1.0 + t * t, 2.0 * t * (1.0 + t * t));
    }
    case Op::asin:
    case Op::acos: {
      const double sign = op == Op::asin ? 1.0 : -1.0;
      const double c2 = 1.0 - v * v;
      return chained(a, op == Op::asin ? std::asin(v) : std::acos(v), sign / std::sqrt(c2),
                     sign * v / (c2 * std::sqrt(c2)));
    }
    case Op::atan: {
      const double d = 1.0 / (1.0 + v * v);
      return chained(a, std::atan(v), d, -2.0 * v * d * d);
    }
    case Op::sinh:
      return chained(a, std::sinh(v), std::cosh(v), std::sinh(v));
    case Op::cosh:
      return chained(a, std::cosh(v), std::sinh(v), std::cosh(v));
    case Op::tanh: {
      const double t = std::tanh(v);
      return chained(a, t, 1.0 - t * t, -2.0 * t * (1.0 - t * t));
    }
    case Op::abs:
      return chained(a, std::abs(v), v < 0.0 ? -1.0 : 1.0, 0.0);
    default:
      return a;
  }
}

Jet Formula::apply(Op op, const Jet& a, const Jet& b) {
  switch (op) {
    case Op::add:
      return sum(a, b, 1.0);
    case Op::subtract:
      return sum(a, b, -1.0);
    case Op::multiply:
      return product(a, b);
    case Op::divide:
      return product(a, chained(b, 1.0 / b.value, -1.0 / (b.value * b.value), 2.0 / (b.value * b.value * b.value)));
    default:
      return power(a, b);
  }
}

Jet Formula::at(double x, double y) const {
  std::array<Jet, kMaxDepth> stack;
  std::size_t size = 0;
  for (const Step& step : steps_) {
    if (step.op == Op::number) {
      stack[size++] = {step.number};
    } else if (step.op == Op::x) {
      stack[size++] = {x, 1.0};
    } else if (step.op == Op::y) {
      stack[size++] = {y, 0.0, 1.0};
    } else if (step.op <= Op::power) {
      --size;
      stack[size - 1] = apply(step.op, stack[size - 1], stack[size]);
    } else {
      stack[size - 1] = apply(step.op, stack[size - 1]);
    }
  }
  return stack[0];
}

}  // namespace retrace::geometry
