#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "fabrication/read/nc_program.h"
#include "requests/descriptions.h"
#include "studies/fabrication/fabricate.h"
#include "studies/fabrication/job_maker.h"
#include "tests/support/prism_jobs.h"
#include "tests/support/refusals.h"

// Tests of the requests for fabrication jobs, NC programs and verifications. They check which words the fields allow
// and which values are refused.

namespace retrace::studies::fabrication_request_test {
namespace {

using Words = std::vector<std::string>;

Words words_of(const std::span<const std::string_view> words) {
  return {words.begin(), words.end()};
}

/// Returns the words that a field of a request allows, in alphabetical order. Returns nothing for an unknown field.
template <class Request>
Words words_of_field(std::string_view name) {
  const requests::Row* const row = requests::row_of(requests::description<Request>(), name);
  if (row == nullptr) return {};
  const auto* const word = std::get_if<schema::Word>(&row->kind);
  Words words = words_of(word != nullptr ? word->words : std::get<schema::WordOrFile>(row->kind).words);
  std::ranges::sort(words);
  return words;
}

Words sorted(Words words) {
  std::ranges::sort(words);
  return words;
}

TEST(FabricationRequests, WordsAreThoseOfThePrograms) {
  EXPECT_EQ(words_of_field<JobRequest>("strategy"), sorted(words_of(fabrication::kStrategyWords)));
  EXPECT_EQ(words_of_field<JobRequest>("workpiece"), sorted(words_of(fabrication::kWorkpieceWords)));
  Words machines;
  for (const fabrication::Machine& machine : fabrication::shipped_machines()) machines.push_back(machine.name);
  EXPECT_EQ(words_of_field<JobRequest>("machine"), sorted(machines));
  Words processes;
  for (const fabrication::Process& process : fabrication::shipped_processes()) processes.push_back(process.name);
  EXPECT_EQ(words_of_field<JobRequest>("process"), sorted(processes));

  Words dialects = words_of(fabrication::kNcDialectWords);
  EXPECT_EQ(words_of_field<FabricationRequest>("dialect"), sorted(dialects));
  Words written;
  for (const fabrication::Dialect& dialect : fabrication::dialects()) written.emplace_back(dialect.name);
  EXPECT_EQ(words_of_field<FabricationRequest>("dialect"), sorted(written));
  dialects.emplace_back("auto");
  EXPECT_EQ(words_of_field<VerificationRequest>("dialect"), sorted(dialects));
}

std::string refusal(const JobRequest& request) {
  return refusal_of([&] { check_job_request(request); });
}

TEST(FabricationRequests, ToolWidthsDependOnTheStrategy) {
  JobRequest request;
  EXPECT_EQ(refusal(request), "tool_width_mm");
  for (const double width_mm : {0.09, 2.1}) {
    request.strategy = "two-step";
    request.tool_width_mm = width_mm;
    EXPECT_EQ(refusal(request), "tool_width_mm");
    request.strategy = "dmc";
    EXPECT_EQ(refusal(request), "");
  }
  for (const double width_mm : {0.009, 10.1}) {
    request.tool_width_mm = width_mm;
    EXPECT_EQ(refusal(request), "tool_width_mm");
  }
}

TEST(FabricationRequests, FieldsAreChecked) {
  JobRequest request;
  request.tool_width_mm = 0.5;
  const auto with = [&](auto member, const auto& value) {
    JobRequest changed = request;
    changed.*member = value;
    return refusal(changed);
  };
  EXPECT_EQ(with(&JobRequest::strategy, "spiral"), "strategy");
  EXPECT_EQ(with(&JobRequest::workpiece, "die"), "workpiece");
  EXPECT_EQ(with(&JobRequest::shrinkage_percent, 50.0), "shrinkage_percent");
  EXPECT_EQ(with(&JobRequest::machine, "kugler"), "machine");
  EXPECT_EQ(with(&JobRequest::machine, "ideal-dmc"), "machine");
  EXPECT_EQ(with(&JobRequest::process, "steel"), "process");
}

TEST(FabricationRequests, ProgramsHaveAllowedFields) {
  const auto refused = [](auto member, const auto& value) {
    FabricationRequest request;
    request.job_text = test::prism_job();
    request.*member = value;
    return refusal_of([&] { fabricate("job.toml", request); });
  };
  EXPECT_EQ(refused(&FabricationRequest::dialect, "kugler"), "dialect");
  EXPECT_EQ(refused(&FabricationRequest::phase, "polishing"), "phase");
  EXPECT_EQ(refused(&FabricationRequest::from_element, 4U), "from_element");
  EXPECT_EQ(refused(&FabricationRequest::from_pass, 1U), "from_pass");
  EXPECT_EQ(refused(&FabricationRequest::stop_every, 0U), "stop_every");
  EXPECT_EQ(refused(&FabricationRequest::split_hours, 0.0), "split_hours");
  EXPECT_EQ(refused(&FabricationRequest::stop_every, 1U), "");
}

TEST(FabricationRequests, JobsOfRuledCellsAreRefused) {
  const std::string text =
      "[element]\nkind = \"ruled\"\n[grooves]\nform = \"equilateral\"\nspacing_mm = 0.1\n"
      "[array]\nx_length_mm = 1\ny_length_mm = 1\n[body]\nthickness_mm = 0.5\n";
  for (const char* strategy : {"bidirectional", "dmc"}) {
    JobRequest request;
    request.strategy = strategy;
    request.tool_width_mm = 0.1;
    EXPECT_EQ(refusal_of([&] { make_job(design::parse_design(text, "d.toml", {}), request); }),
              "d.toml:2: element.kind");
  }
}

}  // namespace
}  // namespace retrace::studies::fabrication_request_test
