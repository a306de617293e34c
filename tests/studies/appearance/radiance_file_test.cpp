// Tests that BSDF files of Radiance are well-formed XML, whatever characters the title of the design contains.

#include "studies/appearance/io/radiance_file.h"

#include <gtest/gtest.h>

#include <random>

#include "core/message_text.h"
#include "tests/report/drawing/svg_reader.h"

namespace retrace::testing::radiance_file_test {
namespace {

TEST(RadianceFile, IsWellFormedForAnyTitle) {
  const std::vector<std::string> pieces = {"]]>",  "]]",       ">",    "<",      "</Name>",   "&",      "&lt;",
                                           "\"",   "'",        "<!--", "--",     "<![CDATA[", "\x1b",   "\n",
                                           "\x7f", "\xc2\x85", "\xff", "\uffff", "\ufffe",    "\u53cd", "prism"};
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, pieces.size() - 1);
  for (int k = 0; k < 2000; ++k) {
    std::string title;
    for (int piece = 0; piece < 5; ++piece) title += pieces[any(random)];
    title = printable(title);
    const std::string xml = studies::radiance_text({}, title);
    ASSERT_EQ(xml.find("]]>"), std::string::npos) << title;
    std::string name;
    for (const SvgElement& element : svg_elements(xml))
      if (element.name == "Name") name = element.text;
    ASSERT_EQ(name, title);
  }
}

}  // namespace
}  // namespace retrace::testing::radiance_file_test
