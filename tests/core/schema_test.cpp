#include "core/schema/schema.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/schema/access.h"
#include "core/schema/json_schema.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "tests/support/key_table.h"
#include "tests/support/refusals.h"

// Tests with a small format that has every kind of key: accepted and refused values, messages, the written text, JSON
// Schema and the documentation.

namespace retrace::schema_test {
namespace {

using namespace schema;
using Json = nlohmann::ordered_json;

enum class Shape { ball, cone };

struct Hole {
  double depth_um = 0.0;
  double angle_deg = 0.0;
  bool operator==(const Hole&) const = default;
};

struct Thing {
  std::string name;
  std::string title;
  Shape shape = Shape::ball;
  double size_mm = 0.0;
  double angle_deg = 0.0;
  double tip_um = 0.0;
  int count = 0;
  bool is_open = false;
  std::vector<double> place_mm;
  std::vector<std::vector<double>> points_mm;
  std::vector<std::string> notes;
  Hole middle;
  bool has_middle = false;
  std::vector<Hole> holes;
  bool operator==(const Thing&) const = default;
};

constexpr std::string_view kShapeWords[] = {"ball", "cone"};
constexpr std::string_view kBall[] = {"ball"};
constexpr std::string_view kCone[] = {"cone"};
constexpr Condition kOfBall[] = {{"shape", Condition::Is::one_of, kBall}};
constexpr Condition kOfCone[] = {{"shape", Condition::Is::one_of, kCone}};
constexpr double kOrigin[] = {0.0, 0.0};
constexpr NumberRange kPositive{.low = 0.0, .low_included = false};

constexpr Row kHoleRows[] = {{"depth_um", Number{kPositive}, kRequired, "Depth of the hole.", access<&Hole::depth_um>},
                             {"angle_deg", Number{{.low = 0.0, .high = 90.0}}, 45.0, "Angle of a cone's hole.",
                              access<&Hole::angle_deg>, kOfCone}};
constexpr Child kMiddle = {
    [](const void* thing) -> std::size_t { return static_cast<const Thing*>(thing)->has_middle ? 1 : 0; },
    child_at<&Thing::middle>,
    [](void* thing) -> void* {
      static_cast<Thing*>(thing)->has_middle = true;
      return &static_cast<Thing*>(thing)->middle;
    }};

constexpr Row kThingRows[] = {
    {"name", Text{}, kRequired, "What it is called.", access<&Thing::name>},
    {"title", Text{}, kNone, "For people.", access<&Thing::title>},
    {"shape", Word{kShapeWords}, "ball", "Its shape.", access<&Thing::shape>},
    {"size_mm", Number{kPositive}, kRequired, "Its size.", access<&Thing::size_mm>},
    {"angle_deg", Number{{.low = 60.0, .high = 120.0}}, kRequired, "Angle of a cone.", access<&Thing::angle_deg>,
     kOfCone},
    {"tip_um", Number{{.low = 0.0, .high = 1.0}}, 0.0, "Radius of the tip.", access<&Thing::tip_um>, kOfCone},
    {"tip_um", Number{{.low = 5.0}}, 7.0, "Radius of the ball.", access<&Thing::tip_um>, kOfBall},
    {"count", Integer{{.low = 1.0, .high = 9.0}}, 3.0, "How many there are.", access<&Thing::count>},
    {"is_open", Flag{}, false, "Whether it is open.", access<&Thing::is_open>},
    {"place_mm", Numbers{2, {.high = 9.0}}, std::span<const double>(kOrigin), "Where it is.", access<&Thing::place_mm>},
    {"points_mm", NumberRows{2, {}, 2, 3, "points"}, Computed{"what the size gives"}, "Its corners.",
     access<&Thing::points_mm>},
    {"notes", Texts{}, kNone, "Remarks.", access<&Thing::notes>}};
constexpr Table kThingTables[] = {{.name = "middle",
                                   .meaning = "The hole in the middle.",
                                   .rows = kHoleRows,
                                   .child = kMiddle,
                                   .presence = Presence::optional,
                                   .layout = Layout::in_line},
                                  {.name = "hole",
                                   .meaning = "A hole.",
                                   .rows = kHoleRows,
                                   .child = children<&Thing::holes>,
                                   .presence = Presence::list}};

std::string too_deep(const Thing& thing) {
  for (const Hole& hole : thing.holes)
    if (hole.depth_um > 1e3 * thing.size_mm) return "must be at least as deep as its holes";
  return {};
}
constexpr std::string_view kSizeKeys[] = {"title", "size_mm"};
constexpr std::string_view kOpenKeys[] = {"is_open", "notes"};
constexpr Rule kThingRules[] = {Check{kSizeKeys, "Holes do not pass through.", check_by<too_deep>},
                                OneOf{kOpenKeys, "must say either is_open or notes"}};
constexpr Format kThing = {
    "thing", "retrace.thing/1", "Thing", {"", "A thing with holes.", kThingRows, kThingTables, kThingRules}};

Thing read(const std::string& text) {
  Thing thing;
  read_object(kThing, text, "f.toml", &thing);
  return thing;
}

const std::string kLeast = "schema = 'retrace.thing/1'\nname = 'a'\nsize_mm = 2\nis_open = false\n";

/// Returns the error message for a minimal file to which the lines `more` are added. The first added line is line 5.
std::string refusal(const std::string& more, const std::string& least = kLeast) {
  return refusal_of([&] { read(least + more); }, "accepted");
}

TEST(Schema, DefaultsHoldForKeysThatAreNotGiven) {
  const Thing thing = read(kLeast);
  EXPECT_EQ(thing.shape, Shape::ball);
  EXPECT_EQ(thing.tip_um, 7.0) << "the default of balls";
  EXPECT_EQ(thing.count, 3);
  EXPECT_EQ(thing.place_mm, (std::vector<double>{0.0, 0.0}));
  EXPECT_TRUE(thing.points_mm.empty());
  EXPECT_FALSE(thing.has_middle);
  EXPECT_EQ(read(kLeast + "shape = 'cone'\nangle_deg = 90\n").tip_um, 0.0) << "the default of cones";
}

TEST(Schema, EveryKindIsRead) {
  const Thing thing = read(kLeast +
                           "title = 't'\nshape = 'cone'\nangle_deg = 90\ntip_um = 0.5\ncount = 4\nplace_mm = [1, 2.5]\n"
                           "points_mm = [[1, 2], [3, 4]]\nmiddle = { depth_um = 1 }\n[[hole]]\ndepth_um = 2\n"
                           "[[hole]]\ndepth_um = 3\nangle_deg = 10\n");
  EXPECT_EQ(thing.title, "t");
  EXPECT_EQ(thing.shape, Shape::cone);
  EXPECT_EQ(thing.count, 4);
  EXPECT_EQ(thing.place_mm, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(thing.points_mm, (std::vector<std::vector<double>>{{1.0, 2.0}, {3.0, 4.0}}));
  EXPECT_EQ(thing.middle, (Hole{1.0, 45.0}));
  EXPECT_EQ(thing.holes, (std::vector<Hole>{{2.0, 45.0}, {3.0, 10.0}}));
}

TEST(Schema, EachKindRefusesWhatItIsNot) {
  const auto without = [](const std::string& line) {
    std::string least = kLeast;
    return least.erase(least.find(line), line.size());
  };
  EXPECT_EQ(refusal("", without("name = 'a'\n")), "f.toml: name");
  EXPECT_EQ(refusal("", without("size_mm = 2\n")), "f.toml: size_mm");
  EXPECT_EQ(refusal("", without("schema = 'retrace.thing/1'\n")), "f.toml: schema");
  EXPECT_EQ(refusal("", "schema = 'retrace.thing/2'\n"), "f.toml:1: schema");
  expect_refusals([](const std::string& given) { return refusal(given); }, {{"title = 3\n", "f.toml:5: title"},
                                                                            {"shape = 'bal'\n", "f.toml:5: shape"},
                                                                            {"shape = 1\n", "f.toml:5: shape"},
                                                                            {"tip_um = nan\n", "f.toml:5: tip_um"},
                                                                            {"tip_um = 'x'\n", "f.toml:5: tip_um"},
                                                                            {"tip_um = 4\n", "f.toml:5: tip_um"},
                                                                            {"count = 0\n", "f.toml:5: count"},
                                                                            {"count = 2.5\n", "f.toml:5: count"}});
  EXPECT_EQ(refusal("is_open = 1\n", without("is_open = false\n")), "f.toml:4: is_open");
  expect_refusals([](const std::string& given) { return refusal(given); },
                  {{"place_mm = 1\n", "f.toml:5: place_mm"},
                   {"place_mm = [1]\n", "f.toml:5: place_mm"},
                   {"place_mm = [1, 10]\n", "f.toml:5: place_mm"},
                   {"points_mm = 1\n", "f.toml:5: points_mm"},
                   {"points_mm = [[1]]\n", "f.toml:5: points_mm"},
                   {"points_mm = [[1, 2]]\n", "f.toml:5: points_mm"}});
  EXPECT_EQ(refusal("notes = []\n", without("is_open = false\n")), "f.toml:4: notes");
  EXPECT_EQ(refusal("notes = [1]\n", without("is_open = false\n")), "f.toml:4: notes");
  expect_refusals([](const std::string& given) { return refusal(given); },
                  {{"middle = 1\n", "f.toml:5: middle"},
                   {"middle = {}\n", "f.toml:5: middle.depth_um"},
                   {"hole = 1\n", "f.toml:5: hole"},
                   {"[[hole]]\n\ndepth_um = -1\n", "f.toml:7: hole[1].depth_um"}});
}

const std::string kTitel = "f.toml:5: titel";

TEST(Schema, UnknownKeysAreToldTheNearest) {
  EXPECT_EQ(refusal("titel = 'a'\n"), kTitel);
  EXPECT_EQ(refusal("[middel]\n"), "f.toml:5: middel");
  EXPECT_EQ(refusal("[[hole]]\ndepth_um = 1\ndepht_um = 1\n"), "f.toml:7: hole[1].depht_um");
}

TEST(Schema, KeysHoldUnderTheirCondition) {
  expect_refusals(
      [](const std::string& given) { return refusal(given); },
      {{"shape = 'cone'\n", "f.toml: angle_deg"},
       {"shape = 'cone'\nangle_deg = 90\ntip_um = 7\n", "f.toml:7: tip_um"},
       {"angle_deg = 90\n", "f.toml:5: angle_deg"},
       {"[[hole]]\ndepth_um = 1\nangle_deg = 20\n", "f.toml:7: hole[1].angle_deg"},
       {"shape = 'cone'\nangle_deg = 90\n[[hole]]\ndepth_um = 1\nangle_deg = 91\n", "f.toml:9: hole[1].angle_deg"}});
}

TEST(Schema, ConditionsThatNameNothingAreRefused) {
  const Condition condition[] = {{"form", Condition::Is::one_of, kBall}};
  EXPECT_THROW(Document(kThing.root).holds(condition, ""), std::logic_error);
}

TEST(Schema, RulesBlameTheFirstOfTheirKeysThatWasGiven) {
  expect_refusals([](const std::string& given) { return refusal(given); },
                  {{"[[hole]]\ndepth_um = 2001\n", "f.toml:3: size_mm"},
                   {"title = 't'\n[[hole]]\ndepth_um = 2001\n", "f.toml:5: title"},
                   {"titel = 't'\n[[hole]]\ndepth_um = 2001\n", kTitel},
                   {"notes = ['a']\n", "f.toml:5: notes"}});
  EXPECT_EQ(refusal("", "schema = 'retrace.thing/1'\nname = 'a'\nsize_mm = 2\n"), "f.toml");
}

TEST(Schema, WritesRowsInOrder) {
  Thing thing = read(kLeast + "shape = 'cone'\nangle_deg = 90\nmiddle = { depth_um = 1 }\n[[hole]]\ndepth_um = 2\n");
  thing.points_mm = {{1.0, 2.0}, {3.0, 4.5}};
  EXPECT_EQ(object_text(kThing, &thing),
            "schema = \"retrace.thing/1\"\nname = \"a\"\nshape = \"cone\"\nsize_mm = 2\nangle_deg = 90\ntip_um = 0\n"
            "count = 3\nis_open = false\nplace_mm = [0, 0]\npoints_mm = [[1, 2], [3, 4.5]]\n"
            "middle = { depth_um = 1, angle_deg = 45 }\n\n[[hole]]\ndepth_um = 2\nangle_deg = 45\n");
}

double real(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30);
}

RC_GTEST_PROP(Schema, ReadsBackWhatItWrites, ()) {
  Thing thing;
  thing.name = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
  thing.shape = *rc::gen::element(Shape::ball, Shape::cone);
  const bool is_cone = thing.shape == Shape::cone;
  thing.size_mm = real(0.5, 3.0);
  thing.angle_deg = is_cone ? real(60.0, 120.0) : 0.0;
  thing.tip_um = is_cone ? real(0.0, 1.0) : real(5.0, 500.0);
  thing.count = *rc::gen::inRange(1, 10);
  thing.is_open = *rc::gen::arbitrary<bool>();
  thing.place_mm = {real(-9.0, 9.0), real(-1e-9, 1e-9)};
  thing.points_mm = {{1.0, real(0.0, 1.0)}, {2.0, real(0.0, 1e30)}};
  const auto hole = [&] { return Hole{real(0.1, 400.0), is_cone ? real(0.0, 90.0) : 0.0}; };
  for (int k = *rc::gen::inRange(0, 4); k > 0; --k) thing.holes.push_back(hole());
  thing.has_middle = *rc::gen::arbitrary<bool>();
  if (thing.has_middle) thing.middle = hole();
  RC_ASSERT(read(object_text(kThing, &thing)) == thing);
}

TEST(Schema, JsonSchemaSaysWhatIsAllowed) {
  const Json json = json_schema(kThing);
  EXPECT_EQ(json["$schema"], "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(json["additionalProperties"], false);
  EXPECT_EQ(json["required"], (Json{"schema", "name", "size_mm"}));
  const Json& keys = json["properties"];
  EXPECT_EQ(keys["schema"]["const"], "retrace.thing/1");
  EXPECT_EQ(keys["size_mm"], (Json{{"description", "Its size. In mm. Holes do not pass through."},
                                   {"type", "number"},
                                   {"exclusiveMinimum", 0.0}}));
  EXPECT_EQ(keys["shape"],
            (Json{{"description", "Its shape."}, {"type", "string"}, {"enum", {"ball", "cone"}}, {"default", "ball"}}));
  EXPECT_EQ(keys["count"]["type"], "integer");
  EXPECT_EQ(keys["points_mm"]["description"], "Its corners. In mm. By default: what the size gives.");
  EXPECT_EQ(keys["points_mm"]["maxItems"], 3);
  EXPECT_EQ(keys["place_mm"]["default"], (Json{0.0, 0.0}));
  EXPECT_EQ(keys["tip_um"], (Json{{"description", "Radius of the tip. In um."}}));
  EXPECT_EQ(keys["hole"]["type"], "array");
  EXPECT_EQ(keys["hole"]["items"]["required"], Json{"depth_um"});
  EXPECT_EQ(json["oneOf"], (Json{{{"required", {"is_open"}}}, {{"required", {"notes"}}}}));
  EXPECT_EQ(json["description"], "A thing with holes.");
}

TEST(Schema, JsonSchemaDecidesConditionsWhereTheirKeyIs) {
  const Json all = json_schema(kThing)["allOf"];
  const Json is_cone = {{"properties", {{"shape", {{"enum", {"cone"}}}}}}, {"required", {"shape"}}};
  const Json is_ball = {{"properties", {{"shape", {{"enum", {"ball"}}}}}}};
  EXPECT_TRUE(std::count(all.begin(), all.end(),
                         Json({{"if", {{"anyOf", {is_cone}}}}, {"else", {{"properties", {{"angle_deg", false}}}}}})));
  const auto then_of = [&](const Json& condition, std::string_view name) {
    for (const Json& each : all)
      if (each["if"] == condition && each["then"]["properties"].contains(name))
        return each["then"]["properties"][std::string(name)];
    return Json();
  };
  EXPECT_EQ(then_of(is_cone, "tip_um")["maximum"], 1.0);
  EXPECT_EQ(then_of(is_ball, "tip_um")["minimum"], 5.0);
  EXPECT_EQ(then_of(is_cone, "hole")["items"]["properties"]["angle_deg"]["maximum"], 90.0);
}

TEST(Schema, KeyTablesOfTheDocumentation) {
  const std::string text = key_tables(kThing);
  EXPECT_EQ(text.substr(0, text.find("| `size_mm`")),
            "| key | default | allowed |\n|---|---|---|\n| `schema` | required | `\"retrace.thing/1\"` |\n"
            "| `name` | required | a text. What it is called. |\n| `title` | none | a text. For people. |\n"
            "| `shape` | `\"ball\"` | `\"ball\"`, `\"cone\"`. Its shape. |\n");
  EXPECT_NE(text.find("| `tip_um` | 7 | at least 5. Radius of the ball. Only for `shape` `\"ball\"`. |\n"),
            std::string::npos);
  EXPECT_NE(text.find("| `count` | 3 | a whole number, 1 to 9. How many there are. |\n"), std::string::npos);
  EXPECT_NE(
      text.find("\n| `[[hole]]` | default | allowed |\n|---|---|---|\n| `depth_um` | required | above 0. Depth of "
                "the hole. |\n"),
      std::string::npos);
}

TEST(Schema, UnitsAreSuffixes) {
  expect_refusals([](const std::string& given) { return unit_of(given); },
                  {{"feed_mm_per_min", "mm/min"}, {"speed_deg_per_s", "degrees/s"}, {"dwell_s", "s"}, {"cuts", ""}});
}

}  // namespace
}  // namespace retrace::schema_test
