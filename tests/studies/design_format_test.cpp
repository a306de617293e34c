#include <gtest/gtest.h>

#include <set>
#include <string>

#include "design/io/design_format.h"
#include "tests/support/documents.h"
#include "tests/support/key_table.h"

// Tests of the rows that define the format of design files. Written designs are read back unchanged, and the
// documentation agrees with the rows.

namespace retrace::studies::design_format_test {
namespace {

using namespace schema;

Document read(const std::string& text) {
  return read_document(design::design_format(), text, "d.toml", kMaxTextBytes);
}

RC_GTEST_PROP(DesignFormat, DocumentsReadBackTheSame, ()) {
  documents_test::expect_random_document_to_read_back(design::design_format());
}

TEST(DesignFormat, ExamplesReadBackTheSame) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(RETRACE_SOURCE_DIR) + "/examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Document document = read_document(design::design_format(), read_file(entry.path()), entry.path().string());
    const std::string text = document_text(design::design_format(), document);
    EXPECT_EQ(document_text(design::design_format(), read(text)), text) << entry.path();
  }
  EXPECT_GE(count, 10U);
}

TEST(DesignFormat, DocumentationSaysWhatTheRowsSay) {
  for (const Table& table : design::design_format().root.tables)
    EXPECT_EQ(documents_test::documented("design_file.md", table.name), key_table(table)) << table.name;
  EXPECT_EQ(documents_test::documented("design_file.md", "rules"), rule_table(design::design_format().root));
}

TEST(DesignFormat, RowsOfAKeyStandTogether) {
  for (const Table& table : design::design_format().root.tables) {
    std::set<std::string_view> seen;
    std::string_view last;
    for (const Row& row : table.rows) {
      EXPECT_TRUE(row.key == last || seen.insert(row.key).second) << table.name << "." << row.key;
      last = row.key;
    }
  }
}

}  // namespace
}  // namespace retrace::studies::design_format_test
