#include "core/csv.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "tests/support/refusals.h"

namespace retrace::csv_test {
namespace {

using namespace std::string_literals;

constexpr std::array<std::string_view, 3> kColumns = {"name", "size_mm", "kind"};
constexpr std::array<std::string_view, 2> kKinds = {"round", "flat"};
constexpr std::size_t kMaxBytes = 200;
const std::string kHead = "name,size_mm,kind\n";

struct Item {
  std::string name;
  double size_mm = 0.0;
  std::size_t kind = 0;
  int line = 0;
};

std::vector<Item> items_of(std::string_view text) {
  std::vector<Item> items;
  CsvReader table(text, "t.csv", kMaxBytes, kColumns);
  while (table.next())
    items.push_back({std::string(table[0]), table.number(1, {.low = 0.0, .low_included = false}),
                     table.one_of(2, kKinds), table.line()});
  if (items.empty()) table.fail("must hold items");
  return items;
}

std::string refused(std::string_view text) {
  return refusal_of([&] { items_of(text); }, "accepted");
}

TEST(CsvReader, TakesMarksBlanksLineEndsAndCommentsAsTheyCome) {
  const auto items =
      items_of("\xef\xbb\xbf# sizes\r\n\r\n name ,\tsize_mm, kind \r\n  a b , +2.5e0,round\r\n#\n ,1 , flat\t");
  ASSERT_EQ(items.size(), 2U);
  EXPECT_EQ(items[0].name, "a b");
  EXPECT_EQ(items[0].size_mm, 2.5);
  EXPECT_EQ(items[0].line, 4);
  EXPECT_EQ(items[1].name, "");
  EXPECT_EQ(items[1].kind, 1U);
  EXPECT_EQ(items[1].line, 6) << "without an end of line";
}

TEST(CsvReader, RefusesATableOfOtherColumns) {
  EXPECT_EQ(refused(""), "t.csv");
  EXPECT_EQ(refused("# only words\n\n"), "t.csv");
  EXPECT_EQ(refused("\xef\xbb\xbf"), "t.csv");
  EXPECT_EQ(refused("a,1,round\n"), "t.csv:1");
  EXPECT_EQ(refused("name,size_mm\n"), "t.csv:1") << "lacks one";
  EXPECT_EQ(refused("\nname,size_mm,kind,more\n"), "t.csv:2");
  EXPECT_EQ(refused("Name,size_mm,kind\n"), "t.csv:1");
  EXPECT_EQ(refused("name,size\0_mm,kind\n"s), "t.csv:1");
}

TEST(CsvReader, RefusesRaggedRowsAndTablesThatAreTooLong) {
  EXPECT_EQ(refused(kHead + "a,1\n"), "t.csv:2");
  EXPECT_EQ(refused(kHead + "a,1,round,\n"), "t.csv:2");
  EXPECT_EQ(refused(kHead + "a\n"), "t.csv:2");
  EXPECT_EQ(refused(kHead), "t.csv");
  EXPECT_EQ(refused(kHead + std::string(kMaxBytes, '#')), "t.csv");
  EXPECT_EQ(refused(kHead + "a,1,round\n" + std::string(kMaxBytes - kHead.size() - 10, '#')), "accepted");
}

TEST(CsvReader, RefusesWhatIsNoNumberOfTheRange) {
  for (const std::string value : {"", "x", "1x", "1 2", "nan", "inf", "-inf", "0x10", "+-1", "++1", "0", "-1"})
    EXPECT_EQ(refused(kHead + "a," + value + ",round\n"), "t.csv:2: size_mm");
  EXPECT_EQ(refused(kHead + "a,1\0,round\n"s), "t.csv:2: size_mm");
  EXPECT_EQ(refused(kHead + "a,1e999,round\n"), "t.csv:2: size_mm");
  EXPECT_EQ(refused(kHead + "a,1,square\n"), "t.csv:2: kind");
  CsvReader table("x\n?\n", "t.csv", kMaxBytes);
  ASSERT_TRUE(table.next());
  EXPECT_THROW(table.number(0), InputError);
}

TEST(CsvReader, ColumnsOfOtherTablesAreFoundByTheirNames) {
  CsvReader table("a,b,a\n1,,3\n", "t.csv", kMaxBytes);
  EXPECT_EQ(table.find("b"), 1U);
  EXPECT_EQ(table.find("c"), std::nullopt);
  EXPECT_THROW(table.find("a"), InputError);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number_or_none(0), 1.0);
  EXPECT_EQ(table.number_or_none(1), std::nullopt);
  EXPECT_FALSE(table.next());
  EXPECT_EQ(table.rows(), 1U);
  EXPECT_THROW(CsvReader("# nothing\n", "t.csv", kMaxBytes), InputError);
}

TEST(CsvWriter, QuotesAndLeavesOutAsSpreadsheetsDo) {
  CsvWriter csv("a,b,c,d");
  csv.row(0.1, std::size_t{3}, true, "plain");
  csv.row(std::numeric_limits<double>::quiet_NaN(), -0.0, std::optional<double>(), std::optional<double>(2.0));
  csv.add("with, comma");
  csv.add("a \"word\"");
  csv.add_quoted("x");
  csv.row("two\nlines");
  EXPECT_EQ(csv.text(), "a,b,c,d\n0.1,3,true,plain\n,0,,2\n\"with, comma\",\"a \"\"word\"\"\",\"x\",\"two\nlines\"\n");
}

TEST(Text, SplitsAndTrims) {
  EXPECT_EQ(trimmed(" \t a b\r"), "a b");
  EXPECT_EQ(trimmed(" \t\r"), "");
  EXPECT_EQ(split("a, b,,", ','), (std::vector<std::string_view>{"a", "b", "", ""}));
  EXPECT_EQ(split("", ','), std::vector<std::string_view>{""});
  EXPECT_EQ(number_in("+1.5"), 1.5);
  EXPECT_EQ(number_in("-1.5"), -1.5);
  for (const char* text : {"", "+", "+-1", "1,5", "nan", "1 ", "1e999"})
    EXPECT_EQ(number_in(text), std::nullopt) << text;
}

}  // namespace
}  // namespace retrace::csv_test
