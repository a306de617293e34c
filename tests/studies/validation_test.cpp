#include "studies/validation/validation.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "studies/validation/io/validation_files.h"
#include "tests/support/refusals.h"

// Tests of the comparison with expected values: differences larger than allowed are detected, reported and marked. The
// values themselves are tested in tests/app/validate_test.cpp.

namespace retrace::studies::validation_test {
namespace {

ValidationRow row_of(double expected, std::optional<double> allowed, double computed) {
  return {.topic = "Topic",
          .quantity = "figure",
          .unit = "mm",
          .reference = Reference::published,
          .expected = expected,
          .source = "source",
          .allowed = allowed,
          .why = "reason",
          .compute = [computed](auto) { return computed; }};
}

TEST(Validation, AWrongExpectedValueOfARealRowFails) {
  std::vector<ValidationRow> rows = validation_rows();
  std::erase_if(rows, [](const ValidationRow& row) { return row.topic != "Cutting forces in aluminium"; });
  ASSERT_FALSE(rows.empty());
  EXPECT_TRUE(validate(rows).holds());
  for (ValidationRow& row : rows) {
    if (!row.allowed) continue;
    const double right = row.expected;
    const double beyond = 2.1 * *row.allowed + 1e-12;
    row.expected = right + beyond;
    EXPECT_FALSE(validate(rows).holds()) << row.quantity;
    row.expected = right - beyond;
    EXPECT_FALSE(validate(rows).holds()) << row.quantity;
    row.expected = right;
  }
}

TEST(Validation, JudgesByWhatIsAllowed) {
  const auto holds = [](const ValidationRow& row) { return validate({row}).rows.at(0).holds(); };
  EXPECT_EQ(holds(row_of(2.0, 0.5, 2.5)), true);
  EXPECT_EQ(holds(row_of(2.0, 0.5, 1.5)), true);
  EXPECT_EQ(holds(row_of(2.0, 0.5, 2.6)), false);
  EXPECT_EQ(holds(row_of(2.0, 0.5, 1.4)), false);
  EXPECT_EQ(holds(row_of(3.0, 0.0, 3.0)), true) << "a count";
  EXPECT_EQ(holds(row_of(3.0, 0.0, 4.0)), false);
  EXPECT_EQ(holds(row_of(2.0, 0.5, std::numeric_limits<double>::quiet_NaN())), false);
  EXPECT_EQ(holds(row_of(2.0, std::nullopt, 9.0)), std::nullopt);
  EXPECT_TRUE(validate({row_of(2.0, std::nullopt, 9.0)}).holds()) << "shown without a verdict";
  EXPECT_FALSE(validate({row_of(1.0, 0.1, 1.0), row_of(2.0, 0.5, 3.0)}).holds());
}

TEST(Validation, SaysWhatIsOutside) {
  const ValidationResult result = validate({row_of(2.0, 0.5, 2.1), row_of(2.0, 0.5, 3.25), row_of(4.06, {}, 2.62)});
  ASSERT_EQ(validation_warnings(result).size(), 1U);
  EXPECT_EQ(validation_warnings(result)[0].id, "not_validated");
  const auto json = nlohmann::json::parse(validation_json(result));
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["rows"][0]["holds"], true);
  EXPECT_EQ(json["rows"][1]["holds"], false);
  EXPECT_FALSE(json["rows"][2].contains("holds"));
  const std::string page = validation_markdown(result);
  EXPECT_NE(page.find("| figure (mm) | 2 | 2.10 | 0.10 | 0.5 | reason | published | source |\n"), std::string::npos)
      << page;
  EXPECT_NE(page.find("| figure (mm) | 2 | 3.25 | **1.25** | 0.5 | reason | published | source |\n"), std::string::npos)
      << page;
  EXPECT_NE(page.find("| figure (mm) | 4.06 | 2.62 | -1.44 | - | reason | published | source |\n"), std::string::npos)
      << page;
}

TEST(Validation, TellsWhatIsFinishedWhenItIsCancelled) {
  Cancellation cancel;
  ValidationRow last = row_of(2.0, 0.5, 2.0);
  last.compute = [&](const Cancellation*) {
    cancel.request();
    return 2.0;
  };
  const ValidationResult result = validate({last, last, last}, nullptr, &cancel);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.rows.size(), 0U) << "what is computed while it is cancelled counts for nothing";
  EXPECT_EQ(nlohmann::json::parse(validation_json(result))["complete"], false);
  EXPECT_NE(validation_markdown(result).find("Interrupted: 0 of 3 figures."), std::string::npos);
}

TEST(Validation, AnErrorOfARowIsThrown) {
  ValidationRow row = row_of(2.0, 0.5, 2.0);
  row.compute = [](const Cancellation*) -> double { throw InputError("no data"); };
  EXPECT_THROW(validate({row}), InputError);
}

}  // namespace
}  // namespace retrace::studies::validation_test
