#include "core/number_format.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <locale>

namespace retrace::number_format_test {
namespace {

using Limits = std::numeric_limits<double>;

double read_back(const std::string& text) {
  double value = Limits::quiet_NaN();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(error, std::errc{}) << text;
  EXPECT_EQ(end, text.data() + text.size()) << text;
  return value;
}

TEST(Shortest, IsTheTextThatPeopleWrite) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(shortest(-40.0), "-40");
  EXPECT_EQ(shortest(587.56), "587.56");
  EXPECT_EQ(shortest(1e-7), "1e-07");
  EXPECT_EQ(shortest(1e300), "1e+300");
  EXPECT_EQ(shortest(0.0), "0");
  EXPECT_EQ(shortest(-0.0), "0") << "a zero has no sign";
}

TEST(Shortest, ExtremesReadBackEqual) {
  for (const double value :
       {Limits::denorm_min(), Limits::min(), std::nextafter(Limits::min(), 0.0), Limits::max(), Limits::lowest(),
        Limits::epsilon(), 1.0 + Limits::epsilon(), 9007199254740993.0, 1.0 / 3.0})
    EXPECT_EQ(read_back(shortest(value)), value);
}

TEST(Shortest, EveryFiniteNumberReadsBackEqual) {
  EXPECT_TRUE(rc::check([](std::uint64_t bits) {
    const auto value = std::bit_cast<double>(bits);
    RC_PRE(std::isfinite(value));
    RC_ASSERT(read_back(shortest(value)) == value);
  }));
}

TEST(Shortest, NoShorterTextReadsBackEqual) {
  EXPECT_TRUE(rc::check([](std::uint64_t bits) {
    const auto value = std::bit_cast<double>(bits);
    RC_PRE(std::isfinite(value) && value != 0.0);
    const std::string text = shortest(value);
    const auto digits = [](const std::string& t) {
      std::size_t count = 0;
      for (const char c : t.substr(0, t.find('e'))) count += c >= '0' && c <= '9' ? 1U : 0U;
      return count;
    };
    if (text.find('e') == std::string::npos || digits(text) < 2) return;
    std::array<char, 64> shorter{};
    const auto [end, error] = std::to_chars(shorter.data(), shorter.data() + shorter.size(), value,
                                            std::chars_format::scientific, static_cast<int>(digits(text)) - 2);
    RC_ASSERT(error == std::errc{});
    double other = 0.0;
    const auto read = std::from_chars(shorter.data(), end, other);
    RC_ASSERT(read.ec != std::errc{} || other != value);
  }));
}

std::string of_charconv(double value) {
  std::array<char, 400> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// The text must equal the output of the standard library if it can print shortest numbers. Both the digits and the
/// layout must agree.
TEST(Shortest, IsWhatTheStandardLibraryWrites) {
  EXPECT_TRUE(rc::check([](std::uint64_t bits, std::int64_t whole, int power) {
    const auto any = std::bit_cast<double>(bits);
    for (const double value :
         {any, static_cast<double>(whole), std::ldexp(static_cast<double>(whole % 1000), power % 300),
          std::pow(10.0, power % 300), static_cast<double>(whole % 1'000'000) * 1e-6})
      if (std::isfinite(value) && value != 0.0) RC_ASSERT(shortest(value) == of_charconv(value));
  }));
}

TEST(Fixed, HasAsManyDigitsAsAskedFor) {
  EXPECT_EQ(fixed(1.0 / 3.0, 4), "0.3333");
  EXPECT_EQ(fixed(2.0, 0), "2");
  EXPECT_EQ(fixed(-12.345, 1), "-12.3");
  EXPECT_EQ(fixed(1e6, 2), "1000000.00");
}

TEST(Fixed, ZeroHasNoSign) {
  EXPECT_EQ(fixed(-0.0, 2), "0.00");
  EXPECT_EQ(fixed(-1e-9, 3), "0.000");
  EXPECT_EQ(fixed(-0.4, 0), "0");
  EXPECT_EQ(fixed(-0.6, 0), "-1");
}

TEST(FixedVisible, SmallValuesAreNotZero) {
  EXPECT_EQ(fixed_visible(1.0 / 3.0, 2), "0.33");
  EXPECT_EQ(fixed_visible(12.3456, 2), "12.35");
  EXPECT_EQ(fixed_visible(1.0 / 300.0, 2), "0.00333");
  EXPECT_EQ(fixed_visible(-0.005, 2), "-0.005");
  EXPECT_EQ(fixed_visible(0.0, 2), "0.00");
  EXPECT_EQ(fixed_visible(1e-12, 2), "0.00") << "a rounding error counts as 0";
  // Below ten units of the last digit, a number has three significant digits.
  EXPECT_EQ(fixed_visible(0.0234, 2), "0.0234");
  EXPECT_EQ(fixed_visible(-0.0999, 2), "-0.0999");
  EXPECT_EQ(fixed_visible(0.1234, 2), "0.12");
}

// The printed number is on the same side of the bound as the exact value.
TEST(FixedApart, KeepsTheSideOfTheBound) {
  EXPECT_EQ(fixed_apart(88.001, 88.0, 2), "88.001");
  EXPECT_EQ(fixed_apart(88.2, 88.0, 2), "88.2");
  EXPECT_EQ(fixed_apart(88.0, 88.0, 2), "88");
  EXPECT_EQ(fixed_apart(120.0, 88.0, 0), "120");
  rc::check("any value and bound", [](double value, double step) {
    RC_PRE(std::isfinite(value) && std::isfinite(step));
    const double bound = value + step;
    RC_PRE(std::isfinite(bound));
    const double shown = std::stod(fixed_apart(value, bound, 2));
    RC_ASSERT((shown < bound) == (value < bound));
    RC_ASSERT((shown > bound) == (value > bound));
  });
}

/// Number format with German separators. It requires no installed locale.
class GermanNumbers : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(NumberFormat, LocaleChangesNothing) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  const std::string numbers = shortest(1234567.25) + " " + fixed(1234567.25, 2);
  std::locale::global(before);
  EXPECT_EQ(numbers, "1234567.25 1234567.25");
}

}  // namespace
}  // namespace retrace::number_format_test
