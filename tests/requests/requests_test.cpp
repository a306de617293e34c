// Tests of the descriptions of requests. Each test checks one rule for every field of every request.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/overloaded.h"
#include "requests/descriptions.h"
#include "requests/json.h"
#include "tests/support/refusals.h"

namespace retrace::requests::requests_test {
namespace {

using schema::Value;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns numbers that a range does not allow: the nearest number beyond each bound, each excluded bound, both
/// infinities and NaN. If the range is one of integers, a number with a fraction is added.
std::vector<double> outside(const NumberRange& range, bool is_whole) {
  std::vector<double> numbers = {kInfinity, -kInfinity, std::nan("")};
  if (std::isfinite(range.low)) {
    numbers.push_back(is_whole ? range.low - 1.0 : std::nextafter(range.low, -kInfinity));
    if (!range.low_included) numbers.push_back(range.low);
  }
  if (std::isfinite(range.high)) {
    numbers.push_back(is_whole ? range.high + 1.0 : std::nextafter(range.high, kInfinity));
    if (!range.high_included) numbers.push_back(range.high);
  }
  if (is_whole) numbers.push_back(std::max(range.low, 0.0) + 0.5);
  return numbers;
}

/// Returns values that a kind does not allow.
std::vector<Value> wrong_values(const schema::Kind& kind) {
  std::vector<Value> wrong;
  const auto add = [&](const std::vector<double>& numbers, std::size_t count) {
    for (const double number : numbers)
      if (count == 0)
        wrong.emplace_back(number);
      else
        wrong.emplace_back(std::vector<double>(count, number));
  };
  std::visit(Overloaded{[&](const schema::Number& number) { add(outside(number.range, false), 0); },
                        [&](const schema::Integer& whole) { add(outside(whole.range, true), 0); },
                        [&](const schema::Numbers& numbers) {
                          add(outside(numbers.range, numbers.is_integer), numbers.count);
                          wrong.emplace_back(std::vector<double>(numbers.count + 1, 1.0));
                        },
                        [&](const schema::NumberOrNumbers& numbers) {
                          add(outside(numbers.range, numbers.is_integer), 1);
                          if (!numbers.may_be_empty) wrong.emplace_back(std::vector<double>());
                        },
                        [&](const schema::Word&) { wrong.emplace_back(std::string("no such word")); },
                        [&](const schema::File&) { wrong.emplace_back(std::string()); },
                        [&](const schema::WordOrFile&) { wrong.emplace_back(std::string()); }, [](const auto&) {}},
             kind);
  if (!std::holds_alternative<schema::Flag>(kind)) wrong.emplace_back(true);
  if (!std::holds_alternative<schema::Texts>(kind)) wrong.emplace_back(std::vector<std::string>{"a", "b"});
  return wrong;
}

/// Calls `action` for each kind of request with its description and a pointer to a request with default values.
void for_each_request(const auto& action) {
  const auto with_defaults = [&]<class Type>(const Type& defaults) {
    Type object = defaults;
    SCOPED_TRACE(std::string(description<Type>().name));
    action(description<Type>(), static_cast<void*>(&object));
  };
  std::apply([&](const auto&... objects) { (with_defaults(objects), ...); }, AllRequests());
}

TEST(Requests, AllAreListed) {
  std::size_t count = 0;
  for_each_request([&](const Request& request, void*) {
    EXPECT_EQ(all_requests()[count], &request);
    ++count;
  });
  EXPECT_EQ(count, all_requests().size());
}

TEST(Requests, NamesAndSpellingsAreUnique) {
  for_each_request([](const Request& request, void*) {
    std::set<std::string> names, options;
    for (const Row& row : request.rows) {
      EXPECT_TRUE(names.insert(std::string(row.name)).second) << row.name;
      EXPECT_TRUE(row.spelling.is_no_option || options.insert(option_of(row)).second) << row.name;
      EXPECT_FALSE(row.meaning.empty() || row.meaning.ends_with('.')) << row.name;
      EXPECT_EQ(row_of(request, row.name), &row);
      EXPECT_EQ(option_of_field(row.field().name), option_of(row)) << row.name << ": qualify the name";
      for (const Need need : row.needs)
        for (const schema::Condition& condition : need)
          EXPECT_TRUE(condition.key == "out" || row_of(request, condition.key) != nullptr)
              << condition.key << " is no field";
    }
  });
}

TEST(Requests, DefaultsAreAllowed) {
  for_each_request([](const Request& request, void* object) {
    for (const Row& row : request.rows) {
      const Value value = row.access.get(object);
      const bool is_unset =
          std::holds_alternative<std::monostate>(value) || value == Value(std::string()) || row.is_required;
      if (!is_unset) set(row, object, value);
      EXPECT_EQ(row.access.get(object), value) << row.name;
      if (!row.is_required) {
        EXPECT_FALSE(row.spelling.otherwise.empty() && row.spelling.usual.empty() && is_unset) << row.name;
      }
    }
  });
}

TEST(Requests, WrongValuesAreRefusedAtTheirField) {
  for_each_request([](const Request& request, void* object) {
    for (const Row& row : request.rows) {
      const Value before = row.access.get(object);
      for (const Value& value : wrong_values(row.kind)) {
        const std::string name(row.name);
        EXPECT_EQ(unrecorded_refusal_of([&] { set(row, object, value); }), name) << value.index();
        EXPECT_EQ(row.access.get(object), before) << name << " was changed";
      }
    }
  });
}

// A value does not change if it is written as text for the command line and read again. Invalid numbers are refused.
TEST(Requests, TextsOfValuesAreRead) {
  for_each_request([](const Request& request, void* object) {
    for (const Row& row : request.rows) {
      const bool is_flag = std::holds_alternative<schema::Flag>(row.kind);
      const std::string text = row.spelling.usual.empty() ? text_of(row, object) : std::string(row.spelling.usual);
      if (is_flag || text.empty() || row.is_required) continue;
      set_text(row, object, text);
      EXPECT_EQ(text_of(row, object), text) << row.name;
      if (!std::holds_alternative<schema::Number>(row.kind) && !std::holds_alternative<schema::Integer>(row.kind))
        continue;
      for (const char* wrong : {"", "x", "1x", "1 2", "0x10", "1,5"})
        EXPECT_EQ(unrecorded_refusal_of([&] { set_text(row, object, wrong); }), std::string(row.name)) << wrong;
    }
  });
}

TEST(Requests, ResetRestoresEveryDefault) {
  for_each_request([](const Request& request, void* object) {
    for (const Row& row : request.rows) {
      reset(request, row, object);
      EXPECT_EQ(row.access.get(object), row.access.get(request.initial())) << row.name;
      EXPECT_EQ(unrecorded_refusal_of([&] { set(row, object, Value()); }), std::string(row.name));
    }
  });
}

// An empty list of numbers may be assigned to a field that is a list of any type.
TEST(Requests, EmptyListsAreOfEveryType) {
  RreRequest request;
  request.incidence_spans_deg = {{0.0, 1.0}};
  set(*row_of(description<RreRequest>(), "incidence_spans_deg"), &request, std::vector<double>());
  EXPECT_TRUE(request.incidence_spans_deg.empty());
}

TEST(Requests, ConditionsAreChecked) {
  CameraRequest request;
  check(request);
  request.lamp = "lamp.ies";
  check(request);
  request.illuminance_lx = 20.0;
  EXPECT_EQ(refusal_of([&] { check(request); }), "illuminance_lx");
  request.illuminance_lx = CameraRequest().illuminance_lx;
  request.lamp.clear();
  request.lamp_aim_deg = 1.0;
  EXPECT_EQ(refusal_of([&] { check(request); }), "lamp_aim_deg");
  DetectorRequest detector;
  detector.cutoff = 1e-3;
  check(detector);
  detector.engine = "montecarlo";
  EXPECT_EQ(refusal_of([&] { check(detector); }), "cutoff");
}

TEST(Requests, FieldsAreSpelledByTheReceiver) {
  RoadRequest request;
  request.distance_m = {1.0};
  try {
    check(request);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().key, "distance_m");
    EXPECT_TRUE(error.message(option_of_field).starts_with("--road-distance-m: ")) << error.message(option_of_field);
    EXPECT_TRUE(error.message(keyword_of_field).starts_with("distance_m: "));
    EXPECT_TRUE(std::string(error.what()).starts_with("distance_m: "));
  }
  DetectorRequest detector;
  detector.engine = "montecarlo";
  detector.cutoff = 1e-3;
  try {
    check(detector);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.message(option_of_field).find("requires --engine auto or exact"), std::string::npos);
    EXPECT_EQ(error.text(), "requires engine auto or exact, got montecarlo");
  }
}

TEST(Requests, DescriptionContainsEveryField) {
  const nlohmann::ordered_json json = description_json();
  ASSERT_EQ(json["requests"].size(), all_requests().size());
  for (std::size_t k = 0; k < all_requests().size(); ++k) {
    const Request& request = *all_requests()[k];
    const auto& fields = json["requests"][k]["fields"];
    ASSERT_EQ(fields.size(), request.rows.size());
    for (std::size_t i = 0; i < fields.size(); ++i) EXPECT_EQ(fields[i]["name"], request.rows[i].name);
  }
}

}  // namespace
}  // namespace retrace::requests::requests_test
