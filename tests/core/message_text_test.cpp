#include "core/message_text.h"

#include <gtest/gtest.h>

#include <string>

#include "core/text.h"

namespace retrace::testing::message_text_test {
namespace {

/// Returns a code point in UTF-8.
std::string utf8(unsigned point) {
  const auto byte = [](unsigned value) { return static_cast<char>(value); };
  if (point < 0x80) return {byte(point)};
  if (point < 0x800) return {byte(0xc0 | (point >> 6)), byte(0x80 | (point & 0x3f))};
  if (point < 0x10000)
    return {byte(0xe0 | (point >> 12)), byte(0x80 | ((point >> 6) & 0x3f)), byte(0x80 | (point & 0x3f))};
  return {byte(0xf0 | (point >> 18)), byte(0x80 | ((point >> 12) & 0x3f)), byte(0x80 | ((point >> 6) & 0x3f)),
          byte(0x80 | (point & 0x3f))};
}

bool is_escaped(unsigned point) {
  const bool is_control = point < 0x20 || (point >= 0x7f && point < 0xa0);
  return is_control || point == 0x2028 || point == 0x2029 || point == 0xfffe || point == 0xffff;
}

TEST(Printable, EveryCharacterIsKeptOrEscaped) {
  for (unsigned point = 0; point < 0x11000; ++point) {
    if (point >= 0xd800 && point < 0xe000) continue;
    const std::string text = utf8(point);
    const std::string shown = printable(text);
    ASSERT_EQ(shown == text, !is_escaped(point)) << point;
    ASSERT_EQ(printable(shown), shown) << point;
    const bool is_layout = point == '\n' || point == '\t';
    ASSERT_EQ(printable_lines("a" + text + "b"), "a" + (is_layout ? text : shown) + "b") << point;
    ASSERT_EQ(shown.front() == '\\', is_escaped(point) || point == '\\') << point;
  }
}

TEST(PrintableLines, LongTextsAreKeptWhole) {
  const std::string line(500, 'x');
  EXPECT_EQ(printable_lines(line + "\n\n" + line + "\n"), line + "\n\n" + line + "\n");
  EXPECT_EQ(printable_lines(""), "");
}

TEST(MarkupText, NothingThatHasAMeaningIsLeft) {
  EXPECT_EQ(markup_text("a ]]> <b> &amp; \" '"), "a ]]&gt; &lt;b&gt; &amp;amp; &quot; &#39;");
  EXPECT_EQ(markup_text("plain \u53cd"), "plain \u53cd");
}

}  // namespace
}  // namespace retrace::testing::message_text_test
