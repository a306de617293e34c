#include "core/json_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace retrace::json_text_test {
namespace {

using Json = nlohmann::ordered_json;
using Limits = std::numeric_limits<double>;

TEST(JsonText, KeysKeepTheirOrderAndFlatObjectsStandOnOneLine) {
  EXPECT_EQ(to_text(Json{{"z", 1}, {"a", "text"}, {"m", true}}), "{\"z\": 1, \"a\": \"text\", \"m\": true}\n");
  EXPECT_EQ(to_text(Json{{"p", {{"x", 1}, {"y", 2}}}, {"q", 3}}), "{\n  \"p\": {\"x\": 1, \"y\": 2},\n  \"q\": 3\n}\n");
  EXPECT_EQ(to_text(Json::object()), "{}\n");
  EXPECT_EQ(to_text(Json{{"list", Json::array()}}), "{\"list\": []}\n");
}

TEST(JsonText, CoordinatesStandOnOneLine) {
  const Json ring = Json::array({Json::array({0, 0.5}), Json::array({1, 2})});
  EXPECT_EQ(to_text(Json{{"rings", Json::array({ring, ring})}}),
            "{\n  \"rings\": [[[0, 0.5], [1, 2]], [[0, 0.5], [1, 2]]]\n}\n");
}

TEST(JsonText, NaNAndInfinityAreLeftOut) {
  const Json json = {{"a", Limits::quiet_NaN()}, {"b", 1.5}, {"c", Limits::infinity()}, {"d", -Limits::infinity()}};
  EXPECT_EQ(to_text(json), "{\"b\": 1.5}\n");
  EXPECT_EQ(to_text(Json{{"a", Limits::quiet_NaN()}}), "{}\n");
  const Json nested = {{"a", {{"x", Limits::quiet_NaN()}, {"y", {{"z", Limits::infinity()}}}}}};
  EXPECT_EQ(Json::parse(to_text(nested)), (Json{{"a", {{"y", Json::object()}}}}));
}

TEST(JsonText, NumbersReadBackEqual) {
  const Json json = {{"numbers",
                      {0.1, 1.0 / 3.0, Limits::denorm_min(), Limits::max(), 1e-300, -2.5, std::uint64_t{1} << 63,
                       std::int64_t{-1} << 62}}};
  const Json read = Json::parse(to_text(json));
  ASSERT_EQ(read["numbers"].size(), 8U);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(read["numbers"][k].get<double>(), json["numbers"][k].get<double>()) << k;
  EXPECT_EQ(read["numbers"][6], json["numbers"][6]);
  EXPECT_EQ(read["numbers"][7], json["numbers"][7]);
}

TEST(JsonText, AnyTextIsEscapedToValidJson) {
  const std::string text = "\"quotes\" \\ \n \t \x01 \u53cd\u5c04";
  EXPECT_EQ(Json::parse(to_text(Json{{text, text}})), (Json{{text, text}}));
  const Json broken = Json::parse(to_text(Json{{"t", "not \xff UTF-8"}}), nullptr, false);
  EXPECT_TRUE(broken.is_object()) << "bytes that are not UTF-8 must not break the document";
}

}  // namespace
}  // namespace retrace::json_text_test
