#include "studies/quantity/io/study_format.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/atomic_file.h"
#include "core/schema/json.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "design/io/design_document.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "tests/support/documents.h"
#include "tests/support/key_table.h"

namespace retrace::studies::study_format_test {
namespace {

using namespace schema;

const std::string kRoot = RETRACE_SOURCE_DIR;

/// Returns the files in a folder of the repository whose names end with .toml.
std::vector<std::filesystem::path> files_in(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot + "/" + folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

/// Expects that a document does not change if it is written as TOML and read back, or written as JSON, converted to
/// TOML and read back.
void expect_round_trips(const Format& format, const std::string& text) {
  const Document document = read_document(format, text, "d.toml");
  const std::string written = document_text(format, document);
  EXPECT_EQ(document_text(format, read_document(format, written, "d.toml")), written);
  const auto json = to_json(document);
  const Document back = read_document(format, toml_of_json(format, json), "d.toml");
  EXPECT_EQ(document_text(format, back), written);
  EXPECT_EQ(to_json(back), json);
}

TEST(StudyFormat, EveryExampleReadsBackTheSame) {
  std::size_t studies = 0;
  for (const auto& file : files_in("examples/studies")) {
    const std::string text = read_file(file);
    if (text.find("retrace.study/1") == std::string::npos) continue;
    SCOPED_TRACE(file);
    expect_round_trips(study_format(), text);
    ++studies;
  }
  EXPECT_GE(studies, 6U);
  for (const auto& file : files_in("examples")) {
    SCOPED_TRACE(file);
    expect_round_trips(design::design_format(), read_file(file));
  }
}

RC_GTEST_PROP(StudyFormat, DocumentsReadBackTheSame, ()) {
  documents_test::expect_random_document_to_read_back(study_format());
}

/// The study contains every form of a value that the format allows.
TEST(StudyFormat, EveryFormOfAValueReadsBackTheSame) {
  expect_round_trips(
      study_format(),
      "title = \"a \\\"title\\\"\"\ndesign = \"d.toml\"\n"
      "[[parameter]]\nkey = [\"a.b\", \"c.d\"]\nvalues = [1, 2.5, \"word\", [1, 2], [[3, 4]]]\n"
      "[[parameter]]\nkey = \"x.y\"\ndistribution = \"triangular\"\nfrom = 1\nto = 3\nmode = 2\n"
      "[[quantity]]\nkind = \"rre\"\nincidence_deg = {from = 0, to = 60, count = 8}\nazimuth_deg = [0, 90]\n"
      "[[quantity]]\nkind = \"photometry\"\nname = \"p\"\nstandard = \"r150\"\narea_cm2 = 30\npoints = 3\n"
      "[optimize]\nmaximize = {rre = 1, \"p.1\" = -0.5}\nfront = {rre = \"max\", \"p.1\" = \"min\"}\n"
      "[[constraint]]\nquantity = \"rre\"\nmin = 0.5\n"
      "[machining]\nstrategy = \"unidirectional\"\n");
}

/// A written design is equal to the design that was read, both in given values and in defaults.
TEST(StudyFormat, DesignsAreWrittenAsTheyAre) {
  for (const std::string folder : {"examples", "examples/fronts"})
    for (const auto& file : files_in(folder)) {
      SCOPED_TRACE(file);
      const design::Design design = design::read_design(file);
      const design::Design back = design::parse_design(design::design_text(design), file.string());
      EXPECT_EQ(to_json(design::document_of(back)), to_json(design::document_of(design)));
    }
}

TEST(StudyFormat, AVariedDesignIsAnOverriddenOne) {
  const std::string file = kRoot + "/examples/rtp_brick_1mm.toml";
  const std::vector<std::string> overrides = {override_text("element.base_mm", 0.1),
                                              override_text("title", "it's \"x\"")};
  EXPECT_EQ(to_json(design::document_of(design::with(design::read_design(file), overrides))),
            to_json(design::document_of(design::read_design(file, overrides))));
  EXPECT_THROW(design::with(design::read_design(file), std::vector<std::string>{"element.apex_angle_deg=20"}),
               InputError);
}

TEST(StudyFormat, DocumentationSaysWhatTheRowsSay) {
  for (const Table& table : study_format().root.tables)
    EXPECT_EQ(documents_test::documented("study_file.md", table.name), key_table(table)) << table.name;
}

}  // namespace
}  // namespace retrace::studies::study_format_test
