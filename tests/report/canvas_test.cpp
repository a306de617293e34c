#include "report/canvas.h"

#include <gtest/gtest.h>

#include <string>

namespace retrace::report::canvas_test {
namespace {

Canvas small_canvas() {
  return Canvas(Canvas::Format::png, {8.0, 8.0}, 1.0);
}

TEST(Printable, KeepsValidTextAndReplacesTheRest) {
  EXPECT_EQ(printable("RRE (°) − α 😀"), "RRE (°) − α 😀");
  EXPECT_EQ(printable("a\nb\tc"), "a b c");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a b");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "b\uffff"),
            "a b ")
      << "what XML may not contain";
  EXPECT_EQ(printable("\xff"), "\ufffd");
  EXPECT_EQ(printable("cut short \xe2\x88"), "cut short \ufffd\ufffd");
  EXPECT_EQ(printable("\xc0\xaf"), "\ufffd\ufffd") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\ufffd\ufffd\ufffd") << "a surrogate";
}

TEST(Fitted, LeavesShortTextsAlone) {
  const Canvas canvas = small_canvas();
  EXPECT_EQ(canvas.fitted("short", {12.0}, 200.0, 2, Ellipsis::end), (std::vector<std::string>{"short"}));
  EXPECT_TRUE(canvas.fitted("", {12.0}, 200.0, 2, Ellipsis::end).empty());
  EXPECT_TRUE(canvas.fitted("   ", {12.0}, 200.0, 2, Ellipsis::end).empty());
}

TEST(Fitted, NeverExceedsWidthAndLines) {
  const Canvas canvas = small_canvas();
  const std::string words = "a title of many words that has to be broken into lines somewhere between its words";
  const std::string one_word(300, 'w');
  for (const std::string& text : {words, one_word, words + one_word, one_word + " " + words}) {
    for (const Ellipsis ellipsis : {Ellipsis::end, Ellipsis::middle}) {
      const auto lines = canvas.fitted(text, {12.0}, 180.0, 2, ellipsis);
      ASSERT_FALSE(lines.empty());
      EXPECT_LE(lines.size(), 2U);
      for (const std::string& line : lines) EXPECT_LE(canvas.text_width(line, {12.0}), 180.0);
      EXPECT_NE(lines.back().find("…"), std::string::npos);
    }
  }
}

TEST(Fitted, KeepsTheEndsOfNames) {
  const Canvas canvas = small_canvas();
  const auto lines =
      canvas.fitted("designs/a_long_folder_of_designs/rtp_offset_0p45mm_odd.toml", {12.0}, 150.0, 1, Ellipsis::middle);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].starts_with("designs"));
  EXPECT_TRUE(lines[0].ends_with("odd.toml"));
}

}  // namespace
}  // namespace retrace::report::canvas_test
