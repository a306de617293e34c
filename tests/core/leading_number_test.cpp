#include "core/leading_number.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <string>

namespace retrace::leading_number_test {
namespace {

/// Compares the result with that of the standard library, if it can read floating-point numbers.
void expect_read_alike(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::optional<LeadingNumber> number = leading_number(text);
  ASSERT_EQ(number.has_value(), error == std::errc{}) << text;
  if (!number) return;
  EXPECT_EQ(number->length, static_cast<std::size_t>(end - text.data())) << text;
  if (std::isnan(value))
    EXPECT_TRUE(std::isnan(number->value)) << text;
  else
    EXPECT_EQ(std::bit_cast<std::uint64_t>(number->value), std::bit_cast<std::uint64_t>(value)) << text;
}

TEST(LeadingNumber, IsWhatTheStandardLibraryReads) {
  for (const char* const text :
       {"",      "-",     ".",       "+1",       " 1",     "1.",        ".5",          "-.5e3x",
        "1e",    "1e+",   "2exp(1)", "0x10",     "inf",    "-INFINITY", "nan",         "nan(1)",
        "1e308", "1e309", "-1e999",  "4.9e-324", "1e-999", "0e999",     "-0.000e-999", "179769313486231580793e289"})
    expect_read_alike(text);
}

TEST(LeadingNumber, ReadsAnyTextOfDigitsAsTheStandardLibrary) {
  EXPECT_TRUE(rc::check([] {
    const auto letter = rc::gen::elementOf(std::string("0123456789.eE-+0123456789"));
    expect_read_alike(*rc::gen::container<std::string>(letter));
  }));
}

}  // namespace
}  // namespace retrace::leading_number_test
