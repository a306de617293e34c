#include "studies/quantity/io/study_format.h"

#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "raytrace/light/ledger.h"
#include "studies/quantity/machining.h"

namespace retrace::studies {
namespace {

using namespace schema;
using fabrication::Strategy;

constexpr NumberRange kAboveZero{.low = 0.0, .low_included = false};
constexpr NumberRange kIncidence{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};
constexpr NumberRange kHalfAngle{.low = 0.0, .low_included = false, .high = 90.0};
constexpr NumberRange kPercent{.low = 0.0, .high = 100.0};

// Keys that describe the varied parameters, and the words and conditions of these keys.

constexpr Words kDistributions = {"normal", "uniform", "triangular"};
constexpr Words kNormal = {"normal"};
constexpr Words kTriangular = {"triangular"};
constexpr Words kScales = {"linear", "log"};
constexpr Condition kNoDistribution[] = {without("distribution", "not allowed beside distribution")};
constexpr Condition kNoValues[] = {without("values", "not allowed beside values")};
constexpr Condition kSteps[] = {kNoDistribution[0], kNoValues[0]};
constexpr Condition kCounts[] = {kNoDistribution[0], kNoValues[0], without("step", "either step or count")};
constexpr Condition kOfNormal[] = {is("distribution", kNormal)};
constexpr Condition kOfTriangular[] = {is("distribution", kTriangular)};

constexpr Row kParameterRows[] = {
    {"key", TextOrTexts{"a key of a design such as \"element.base_mm\", or a list of keys"}, kRequired,
     "What it sets: a key of a design, of `[analysis]` or of `[machining]`; a list of keys gives all of them one "
     "value. "
     "`\"design\"`: the values are design files."},
    {"name", Text{}, Computed{"the first key"}, "Of the column in results."},
    {"values", Anything{}, kNone, "Numbers, words or lists.", kNoDistribution},
    {"from", Number{}, kNone,
     "First value, or lower end of an interval for samples; of `\"uniform\"` and `\"triangular\"` parts; where "
     "`\"normal\"` ones are cut off.",
     kNoValues},
    {"to", Number{}, kNone, "Last value, the upper end likewise.", kNoValues},
    {"step", Number{kAboveZero}, kNone, "Values are from + i step, the end included.", kSteps},
    {"count", Whole{{.low = 2.0, .high = 100'000.0}}, kNone, "So many values, ends included.", kCounts},
    {"scale", Word{kScales}, "linear", "`\"log\"`: values in equal ratios.", kSteps},
    {"distribution", Word{kDistributions}, kNone, "How manufacture spreads it, for samples and `retrace tolerance`."},
    {"mean", Number{}, kRequired, "Of the distribution.", kOfNormal},
    {"sigma", Number{kAboveZero}, kRequired, "Standard deviation.", kOfNormal},
    {"mode", Number{}, kRequired, "Its most frequent value, from `from` to `to`.", kOfTriangular}};

// Keys that describe the quantities that are computed for every design, with their words and conditions.

constexpr Words kKinds = {"rre",
                          "ledger",
                          "far_field",
                          "photometry",
                          "elements_full",
                          "elements_partial",
                          "element_depth_mm",
                          "lens_thickness_mm",
                          "facet_area_mm2",
                          "effective_area_mm2",
                          "entrance_area_mm2",
                          "full_element_share",
                          "tir_limit_deg",
                          "tool_fit_mm",
                          "machining_time_h",
                          "machining_time_per_element_s",
                          "area_rate_mm2_per_h",
                          "process_sa_nm",
                          "root_radius_um"};
constexpr Words kShares = {"rre", "ledger", "far_field"};
constexpr Words kLedger = {"ledger"};
constexpr Words kFarField = {"far_field"};
constexpr Words kInCone = {"rre", "ledger"};
constexpr Words kPhotometry = {"photometry"};
constexpr Words kWeightings = {"uniform", "solid_angle"};
constexpr Words kReductions = {"mean", "least", "each"};
constexpr Words kFigures = {"margin", "r_i_mcd_per_lx", "r_a"};
constexpr Words kPoints = {"worst", "each", "each_reading"};
constexpr Words kLights = {"a", "d65", "design"};
constexpr Words kFarFields = {"geometric", "diffracted"};
constexpr Words kMiddles = {"from", "to", "count"};
constexpr Condition kOfShares[] = {is("kind", kShares)};
constexpr Condition kOfLedger[] = {is("kind", kLedger)};
constexpr Condition kOfFarField[] = {is("kind", kFarField)};
constexpr Condition kOfCone[] = {is("kind", kInCone)};
constexpr Condition kOfPhotometry[] = {is("kind", kPhotometry)};
constexpr Computed kOfAnalysis{"that of [analysis]"};
constexpr Computed kOfCommand{"as `retrace photometry`"};
constexpr Kind kMiddlesOfParts = ByName{Number{}, kMiddles, "a number, a list or {from, to, count}"};
constexpr std::string_view kAngles =
    "A number, a list, or `{from = 0, to = 60, count = 8}`: the middles of so many equal parts.";

constexpr Row kQuantityRows[] = {
    {"kind", Word{kKinds}, kRequired, "What it is."},
    {"name", Text{}, Computed{"the kind"}, "Of its column, where the kind would be no unique name."},
    {"incidence_deg", NumberOrNumbers{kIncidence}, kOfAnalysis, kAngles, kOfShares},
    {"incidence_deg", kMiddlesOfParts, kNone, kAngles, kOfShares},
    {"azimuth_deg", NumberOrNumbers{{}}, kOfAnalysis, kAngles, kOfShares},
    {"azimuth_deg", kMiddlesOfParts, kNone, kAngles, kOfShares},
    {"over_directions", Word{kReductions}, "mean",
     "`\"least\"`: the worst direction; `\"each\"`: one quantity a direction, called `NAME.1`, `NAME.2`, ...",
     kOfShares},
    {"weighting", Word{kWeightings}, "uniform", "`\"solid_angle\"`: directions count by \\|sin incidence\\|.",
     kOfShares},
    {"account", Word{raytrace::kAccountNames}, kRequired, "Of the ledger.", kOfLedger},
    {"from_deg", Number{kHalfAngle}, kRequired, "Half-angle round the direction to the source.", kOfFarField},
    {"to_deg", Number{kHalfAngle}, kRequired, "Half-angle up to which light counts.", kOfFarField},
    {"acceptance_half_angle_deg", Number{kHalfAngle}, Computed{"the design's narrowest"}, "In air.", kOfCone},
    {"standard", Text{"r150, j594, bicycle or the name of a limits file"}, kRequired,
     "A shipped standard, or a limits file from the folder of the study.", kOfPhotometry},
    {"class", Text{}, kOfCommand, "Of the standard.", kOfPhotometry},
    {"colour", Text{}, kOfCommand, "Of the standard.", kOfPhotometry},
    {"area_cm2", Number{{.low = 0.0, .low_included = false, .high = 1e6}}, kRequired, "Of the part.", kOfPhotometry},
    {"figure", Word{kFigures}, "margin",
     "`\"margin\"`: value over limit less 1, so that at least 0 passes; `\"r_a\"`: in cd/(lx m2).", kOfPhotometry},
    {"points", Word{kPoints}, "worst",
     "`\"worst\"`: the least of all test points; `\"each\"`: one quantity a point, called `NAME.1`, `NAME.2`, ...; "
     "`\"each_reading\"`: one for each place where a point is measured, V beside it and turns of the part, called "
     "`NAME.1.1`, `NAME.1.2`, ...; or the number of a point, from 1, as `retrace photometry` lists them.",
     kOfPhotometry},
    {"points", Whole{{.low = 1.0, .high = 10'000.0}}, kNone, "The number of a point.", kOfPhotometry},
    {"rotation_deg", NumberOrNumbers{{}}, kOfCommand, "Of the part about its axis.", kOfPhotometry},
    {"window_deg", Number{{.low = 0.05, .high = 10.0}}, kOfCommand, "Half-width of the far field.", kOfPhotometry},
    {"light", Word{kLights}, "a", "`\"design\"`: what the design says.", kOfPhotometry},
    {"far_field", Word{kFarFields}, "diffracted", "`\"geometric\"` is quicker.", kOfPhotometry},
    {"dye", Text{}, kOfCommand, "Of a coloured lens.", kOfPhotometry}};

// Keys of the tables [analysis] and [machining], with their words and conditions.

constexpr Words kEngines = {"auto", "exact", "stochastic", "montecarlo", "cell", "embree"};
constexpr Words kRayEngineWords = {"auto", "montecarlo", "cell", "embree"};
constexpr Words kCutoffEngineWords = {"auto", "exact", "montecarlo", "cell", "embree"};
constexpr Condition kOfRays[] = {is("engine", kRayEngineWords)};
constexpr Condition kOfCutoff[] = {is("engine", kCutoffEngineWords)};
constexpr Row kAnalysisRows[] = {
    {"incidence_deg", Number{kIncidence}, 0.0, "For quantities that do not give their own."},
    {"azimuth_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0, "For quantities that do not give their own."},
    {"rotation_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0,
     "Rotation of the part about its normal, counter-clockwise as seen from the light, for all optical quantities."},
    {"engine", Word{kEngines}, "auto", "As `retrace rre --engine`."},
    {"target_error", Number{{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false}}, Computed{"1e-4"},
     "As for `retrace rre --target-error`. Needs a quantity of RRE."},
    {"samples", Whole{{.low = 1.0, .high = 0x1p36}}, kNone, "Number of rays, as for `retrace rre --samples`.", kOfRays},
    {"cutoff", Number{{.low = 0.0, .high = 1.0, .high_included = false}}, kNone,
     "As for `retrace rre --cutoff`. Photometry by rays has no cut-off.", kOfCutoff}};

constexpr Words kStrategies = {"two-step", "unidirectional"};
constexpr Words kUnidirectional = {"unidirectional"};
constexpr Words kSurfaces = {"as_designed", "as_cut"};
constexpr NumberRange kSane{.low = 1e-6, .high = 1e6};
constexpr NumberRange kSaneOrNone{.low = 0.0, .high = 1e6};
constexpr Condition kFinishing[] = {
    is_not("strategy", kUnidirectional, "not allowed for strategy = \"unidirectional\", which finishes no facet")};

Value tool_width(const MachiningProcess& process) {
  return process.tool_width_mm ? Value(*process.tool_width_mm) : Value();
}
void set_tool_width(MachiningProcess& process, const Value& value) {
  process.tool_width_mm = std::get<double>(value);
}
Value strategy(const MachiningProcess& process) {
  return process.strategy == Strategy::unidirectional ? 1.0 : 0.0;
}
void set_strategy(MachiningProcess& process, const Value& value) {
  const bool finishes = std::get<double>(value) == 0.0;
  process.strategy = finishes ? Strategy::two_step : Strategy::unidirectional;
  if (!finishes) process.finishing_cuts = 0;
}
Value surface(const MachiningProcess& process) {
  return process.surface_as_cut ? 1.0 : 0.0;
}
void set_surface(MachiningProcess& process, const Value& value) {
  process.surface_as_cut = std::get<double>(value) == 1.0;
}

using Process = MachiningProcess;
constexpr Row kMachiningRows[] = {
    {"tool_width_mm", Number{kSane}, Computed{"the element's width"},
     "An element wider than the tool takes several passes.", access_by<tool_width, set_tool_width>},
    {"clearance_um", Number{kSaneOrNone}, 200.0, "Normal to the face of the workpiece.",
     access<&Process::clearance_um>},
    {"roughing_depth_um", Number{kSane}, 15.0, "Of a cut.", access<&Process::roughing_depth_um>},
    {"finishing_depth_um", Number{kSaneOrNone}, 5.0, "Of a cut.", access<&Process::finishing_depth_um>},
    {"finishing_cuts", Whole{{.low = 0.0, .high = 1000.0}}, 2.0, "Of each facet.", access<&Process::finishing_cuts>,
     kFinishing},
    {"plough_length_um", Number{kSaneOrNone}, 100.0, "Of every roughing cut.", access<&Process::plough_length_um>},
    {"roughing_feed_mm_per_min", Number{kSane}, 50.0, "Of roughing cuts.", access<&Process::roughing_feed_mm_per_min>},
    {"finishing_feed_mm_per_min", Number{kSane}, 20.0, "Of finishing cuts.",
     access<&Process::finishing_feed_mm_per_min>},
    {"traverse_feed_mm_per_min", Number{kSane}, 200.0, "Between cuts.", access<&Process::traverse_feed_mm_per_min>},
    {"dwell_s", Number{{.low = 0.0, .high = 3600.0}}, 0.1, "At every root.", access<&Process::dwell_s>},
    {"strategy", Word{kStrategies}, "two-step", "`\"unidirectional\"` finishes no facet.",
     access_by<strategy, set_strategy>},
    {"edge_radius_um", Number{{.low = 0.0, .high = 1000.0}}, 0.0, "Of the tool's cutting edge.",
     access<&Process::edge_radius_um>},
    {"surface", Word{kSurfaces}, "as_designed",
     "`\"as_cut\"`: facets have the roughness and waviness that the strategy was published to leave, roots the radius "
     "of the edge, whatever the design says; `--set` and parameters of the study count more.",
     access_by<surface, set_surface>}};

// Keys of the sweep, the tolerance study and the optimization, with their words and conditions.

constexpr Words kCombinations = {"grid", "zipped", "sobol", "latin_hypercube", "monte_carlo"};
constexpr Words kSampled = {"sobol", "latin_hypercube", "monte_carlo"};
constexpr Condition kOfSampled[] = {
    is("combine", kSampled, "only allowed for combine = \"sobol\", \"latin_hypercube\" and \"monte_carlo\"")};
constexpr Row kSweepRows[] = {
    {"combine", Word{kCombinations}, "grid",
     "`\"grid\"`: every value with every other, the last parameter fastest; `\"zipped\"`: the first values of all, the "
     "second, ...; `\"sobol\"`: Owen-scrambled Sobol points, best with a power of two; `\"latin_hypercube\"`; "
     "`\"monte_carlo\"`: each point drawn by itself."},
    {"samples", Whole{{.low = 1.0, .high = 1'000'000.0}}, kRequired, "Points.", kOfSampled}};

constexpr Words kSense = {"most", "least"};
constexpr std::string_view kQuantityOrWeights = "a quantity or a table of weights";
constexpr std::string_view kObjective =
    "A quantity, or a table of weights such as `{rre = 1, machining_time_h = -0.001}`.";
constexpr Row kOptimiseRows[] = {
    {"maximize", Text{kQuantityOrWeights}, kNone, kObjective},
    {"maximize", ByName{Number{}, {}, kQuantityOrWeights}, kNone, kObjective},
    {"minimize", Text{kQuantityOrWeights}, kNone, kObjective},
    {"minimize", ByName{Number{}, {}, kQuantityOrWeights}, kNone, kObjective},
    {"front", ByName{Word{kSense}, {}, "a table such as {rre = \"most\", machining_time_h = \"least\"}"},
     Computed{"the objective's quantities"}, "Axes of the Pareto front."},
    {"scan", Whole{{.low = 3.0, .high = 100'000.0}}, 65.0,
     "Designs of the first look for every combination of discrete values: a line from end to end for one continuous "
     "parameter, corners and Sobol points for more."},
    {"bands_of", Texts{}, kNone, "Keys of the design, or of parameters, whose tolerance bands are asked for."},
    {"band_loss_percent", Number{{.low = 0.0, .low_included = false, .high = 100.0}}, 1.0,
     "Loss of the objective's first quantity that ends a band."}};
constexpr Words kObjectives = {"maximize", "minimize"};
constexpr Rule kOptimiseRules[] = {
    OneOf{kObjectives, "either maximize or minimize is required: a quantity or a table of weights"}};

constexpr Words kIndices = {"none", "sobol"};
constexpr Row kToleranceRows[] = {
    {"samples", Whole{{.low = 2.0, .high = 1'000'000.0}}, 256.0,
     "Rows. A row is two parts, and as many more points as there are parameters; without indices one part."},
    {"sampling", Word{kSampled}, "sobol", "How they are drawn."},
    {"indices", Word{kIndices}, "sobol", "Sobol indices: which parameter causes the spread."},
    {"confidence_percent", Number{{.low = 50.0, .high = 99.99}}, 95.0, "Of all intervals."},
    {"least_yield_percent", Number{kPercent}, kNone, "A yield below it makes the answer no (exit code 1)."}};

constexpr Words kOver = {"cell", "part"};
constexpr Row kConstraintRows[] = {{"quantity", Text{"a quantity of the study"}, kRequired, "What is limited."},
                                   {"min", Number{}, kNone, "Its least value."},
                                   {"max", Number{}, kNone, "Its largest value."},
                                   {"over", Word{kOver}, "cell",
                                    "Of `retrace compose`: `\"cell\"`, cells that break it are none of the family; "
                                    "`\"part\"`, it is on the mean over the part."}};

constexpr Row kComposeRows[] = {
    {"maximize", TextOrTexts{"a quantity of the study, or a list of them"}, kRequired,
     "The quantities of which the least is to be as large as it can be; `\"margin\"` stands for `margin.1`, "
     "`margin.1.1`, ... as well. Each is a mean over the area: no least of several points, turns or directions."},
    {"least", Number{}, Computed{"0 where all of them are margins"},
     "What the least must reach; a part below it makes the answer no (exit code 1)."},
    {"most_zones", Whole{{.low = 1.0, .high = 100.0}}, kNone, "So many kinds of cells at most."},
    {"least_share", Number{{.low = 0.0, .high = 1.0}}, 0.0, "Of the area, of a zone that is there."},
    {"most_share", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 1.0, "Of the area, of each zone."},
    {"price", ByName{Number{}, {}, "a table of prices such as {machining_time_h = 0.01}"}, kNone,
     "What one more of the mean of a quantity over the part takes from the least."},
    {"front", ByName{Word{kSense}, {}, "a table of one quantity, such as {machining_time_h = \"least\"}"}, kNone,
     "The mean over the part that the least is told against, and which way it is better."},
    {"scan", Whole{{.low = 3.0, .high = 100'000.0}}, 65.0,
     "Cells of the first look for every combination of discrete values, as in [optimize]."},
    {"rounds", Whole{{.low = 0.0, .high = 100.0}}, 4.0, "Searches by prices, at most."},
    {"starts", Whole{{.low = 1.0, .high = 100.0}}, 3.0, "Cells that each search goes out from."},
    {"looks", Whole{{.low = 1.0, .high = 10'000.0}}, 20.0, "Cells that it looks at from each."},
    {"cell_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, kNone,
     "Standard deviation of every angle between facets from cell to cell, which averages out over a zone."},
    {"zone_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, kNone,
     "The same from zone to zone, which does not. With either of the two, what errors of angle do to the part is told; "
     "0 is allowed."},
    {"parts", Whole{{.low = 16.0, .high = 16'384.0}}, 1024.0, "Parts with errors that are drawn, for the yield."},
    {"worst_share", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, kNone,
     "A part is told, too, that is best for so many of the drawn parts, the worst: 0.05 for one in twenty."}};

constexpr Row kRootRows[] = {
    {"title", Text{}, kNone, "Names the study in results."},
    {"design", File{"a design file"}, kNone, "The design that is varied, from the folder of the study."}};
const Table kTables[] = {
    {.name = "parameter",
     .meaning = "What varies.",
     .rows = kParameterRows,
     .presence = Presence::list,
     .shape = "one or more tables [[parameter]]"},
    {.name = "quantity",
     .meaning = "What is asked of every design.",
     .rows = kQuantityRows,
     .presence = Presence::list,
     .shape = "one or more tables [[quantity]]"},
    {.name = "analysis",
     .meaning = "How quantities are computed.",
     .rows = kAnalysisRows,
     .presence = Presence::implied},
    {.name = "machining",
     .meaning = "How prisms are cut; the defaults are those of published samples in acrylic.",
     .rows = kMachiningRows,
     .presence = Presence::implied},
    {.name = "sweep", .meaning = "How values make points.", .rows = kSweepRows, .presence = Presence::implied},
    {.name = "optimize",
     .meaning = "What is best.",
     .rows = kOptimiseRows,
     .rules = kOptimiseRules,
     .presence = Presence::optional},
    {.name = "compose",
     .meaning = "Of which cells a part is best composed.",
     .rows = kComposeRows,
     .presence = Presence::optional},
    {.name = "constraint",
     .meaning = "What a good part holds.",
     .rows = kConstraintRows,
     .presence = Presence::list,
     .shape = "one or more tables [[constraint]]"},
    {.name = "tolerance",
     .meaning = "How many parts are made with errors of manufacture.",
     .rows = kToleranceRows,
     .presence = Presence::implied}};

const Format kFormat = {
    "study",
    "retrace.study/1",
    "Study of a design",
    {.name = "", .meaning = "What varies, and what is asked.", .rows = kRootRows, .tables = kTables},
    true};

}  // namespace

const Format& study_format() {
  return kFormat;
}

}  // namespace retrace::studies
