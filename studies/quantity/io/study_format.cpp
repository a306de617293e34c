#include "studies/quantity/io/study_format.h"

#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "fabrication/job/tool_limits.h"
#include "raytrace/engines/engine.h"
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
constexpr Condition kNoDistribution[] = {is_absent("distribution", "not allowed together with distribution")};
constexpr Condition kNoValues[] = {is_absent("values", "not allowed together with values")};
constexpr Condition kSteps[] = {kNoDistribution[0], kNoValues[0]};
constexpr Condition kCounts[] = {kNoDistribution[0], kNoValues[0], is_absent("step", "not allowed together with step")};
constexpr Condition kOfNormal[] = {is("distribution", kNormal)};
constexpr Condition kOfTriangular[] = {is("distribution", kTriangular)};

constexpr Row kParameterRows[] = {
    {"key", TextOrTexts{"a key of a design such as \"element.base_mm\", or a list of keys"}, kRequired,
     "Keys that the parameter sets: a key of a design, of `[analysis]` or of `[machining]`, or a list of such keys, "
     "which all get the same value. `\"design\"`: the values of the parameter are design files."},
    {"name", Text{}, Computed{"the first key"}, "Name of the parameter's column in results."},
    {"values", Anything{}, kNone, "Values of the parameter: numbers, words or lists.", kNoDistribution},
    {"from", Number{}, kNone,
     "First value, or lower end of the interval from which samples are drawn. For the distributions `\"uniform\"` and "
     "`\"triangular\"`, it is the lower end; `\"normal\"` distributions are truncated there.",
     kNoValues},
    {"to", Number{}, kNone,
     "Last value, or upper end of the interval from which samples are drawn. For the distributions `\"uniform\"` and "
     "`\"triangular\"`, it is the upper end; `\"normal\"` distributions are truncated there.",
     kNoValues},
    {"step", Number{kAboveZero}, kNone,
     "Step between the values. The values are `from` + i `step`, up to and including `to`.", kSteps},
    {"count", Integer{{.low = 2.0, .high = 100'000.0}}, kNone,
     "Number of values from `from` to `to`, including both ends.", kCounts},
    {"scale", Word{kScales}, "linear", "Spacing of the values. `\"log\"`: neighbouring values have equal ratios.",
     kSteps},
    {"distribution", Word{kDistributions}, kNone,
     "Distribution of the parameter in manufacture. It is used for samples and by `retrace tolerance`."},
    {"mean", Number{}, kRequired, "Mean of the distribution.", kOfNormal},
    {"sigma", Number{kAboveZero}, kRequired, "Standard deviation of the distribution.", kOfNormal},
    {"mode", Number{}, kRequired, "Most probable value of the distribution, between `from` and `to`.", kOfTriangular}};

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
                          "full_element_area_fraction",
                          "tir_limit_deg",
                          "tool_fit_mm",
                          "machining_time_h",
                          "machining_time_per_element_s",
                          "area_rate_mm2_per_h",
                          "process_sa_nm",
                          "root_radius_um",
                          "machine_travel_mm",
                          "edge_life_margin_mm"};
constexpr FormerWord kFormerKinds[] = {{"full_element_share", "full_element_area_fraction"}};
constexpr Words kFractionKinds = {"rre", "ledger", "far_field"};
constexpr Words kLedger = {"ledger"};
constexpr Words kFarField = {"far_field"};
constexpr Words kInCone = {"rre", "ledger"};
constexpr Words kPhotometry = {"photometry"};
constexpr Words kWeightings = {"uniform", "solid_angle"};
constexpr Words kReductions = {"mean", "min", "each"};
constexpr FormerWord kFormerReductions[] = {{"least", "min"}};
constexpr Words kFigures = {"margin", "r_i_mcd_per_lx", "r_a"};
constexpr Words kPoints = {"worst", "each", "each_reading"};
constexpr Words kLights = {"a", "d65", "design"};
constexpr Words kFarFields = {"geometric", "diffracted"};
constexpr Words kMiddles = {"from", "to", "count"};
constexpr Condition kOfFractions[] = {is("kind", kFractionKinds)};
constexpr Condition kOfLedger[] = {is("kind", kLedger)};
constexpr Condition kOfFarField[] = {is("kind", kFarField)};
constexpr Condition kOfCone[] = {is("kind", kInCone)};
constexpr Condition kOfPhotometry[] = {is("kind", kPhotometry)};
constexpr Computed kOfAnalysis{"that of [analysis]"};
constexpr Computed kOfCommand{"as for `retrace photometry`"};
constexpr Kind kMiddlesOfParts = ByName{Number{}, kMiddles, "a number, a list or {from, to, count}"};
constexpr std::string_view kAngles =
    "Angles of the directions: a number, a list, or `{from = 0, to = 60, count = 8}`, which means the centres of "
    "`count` equal intervals.";

constexpr Row kQuantityRows[] = {
    {"kind", Word{.words = kKinds, .former = kFormerKinds}, kRequired, "Kind of quantity."},
    {"name", Text{}, Computed{"the kind"},
     "Name of the quantity's column in results. It is needed if several quantities have the same kind."},
    {"incidence_deg", NumberOrNumbers{kIncidence}, kOfAnalysis, kAngles, kOfFractions},
    {"incidence_deg", kMiddlesOfParts, kNone, kAngles, kOfFractions},
    {"azimuth_deg", NumberOrNumbers{{}}, kOfAnalysis, kAngles, kOfFractions},
    {"azimuth_deg", kMiddlesOfParts, kNone, kAngles, kOfFractions},
    {"over_directions", Word{.words = kReductions, .former = kFormerReductions}, "mean",
     "Method by which the values of several directions are combined. `\"mean\"`: weighted mean. `\"min\"`: minimum "
     "over all directions. `\"each\"`: one quantity for each direction, named `NAME.1`, `NAME.2`, ...",
     kOfFractions},
    {"weighting", Word{kWeightings}, "uniform",
     "Weights of the directions. `\"uniform\"`: all weights are equal. `\"solid_angle\"`: the weight is \\|sin "
     "incidence\\|.",
     kOfFractions},
    {"account", Word{raytrace::kAccountNames}, kRequired, "Account of the ledger whose power is the quantity.",
     kOfLedger},
    {"from_deg", Number{kHalfAngle}, kRequired,
     "Lower limit of the angle to the direction to the source. Light between both limits counts.", kOfFarField},
    {"to_deg", Number{kHalfAngle}, kRequired,
     "Upper limit of the angle to the direction to the source. Light between both limits counts.", kOfFarField},
    {"acceptance_half_angle_deg", Number{kHalfAngle}, Computed{"the smallest half-angle of the design"},
     "Half-angle of the acceptance cone, in air.", kOfCone},
    {"standard", Text{"r150, j594, bicycle or the name of a limits file"}, kRequired,
     "Shipped standard, or a limits file with its path relative to the folder of the study.", kOfPhotometry},
    {"class", Text{}, kOfCommand, "Class of the standard.", kOfPhotometry},
    {"colour", Text{}, kOfCommand, "Colour of the standard.", kOfPhotometry},
    {"area_cm2", Number{{.low = 0.0, .low_included = false, .high = 1e6}}, kRequired,
     "Area of the part, to which R_I refers.", kOfPhotometry},
    {"figure", Word{kFigures}, "margin",
     "Result for each test point. `\"margin\"`: value divided by limit, minus 1; a point passes if its margin is at "
     "least 0. `\"r_i_mcd_per_lx\"`: R_I in mcd/lx. `\"r_a\"`: R_A in cd/(lx m2).",
     kOfPhotometry},
    {"points", Word{kPoints}, "worst",
     "Selection of test points. `\"worst\"`: the minimum over all test points. `\"each\"`: one quantity for each "
     "point, named `NAME.1`, `NAME.2`, ... `\"each_reading\"`: one quantity for each reading, named `NAME.1.1`, "
     "`NAME.1.2`, ...; a point has one reading for each rotation of the part and for each angle V next to the mirror "
     "image of the lamp. A number: the point with this number, from 1, in the list of `retrace photometry`.",
     kOfPhotometry},
    {"points", Integer{{.low = 1.0, .high = 10'000.0}}, kNone, "Number of a test point.", kOfPhotometry},
    {"rotation_deg", NumberOrNumbers{{}}, kOfCommand, "Rotations of the part about its axis.", kOfPhotometry},
    {"window_deg", Number{{.low = 0.05, .high = 10.0}}, kOfCommand, "Half-angle of the computed far field.",
     kOfPhotometry},
    {"light", Word{kLights}, "a", "Light of the lamp: CIE A, CIE D65 or, with `\"design\"`, the light of the design.",
     kOfPhotometry},
    {"far_field", Word{kFarFields}, "diffracted",
     "Method for the far field. `\"diffracted\"` includes diffraction. `\"geometric\"` does not, and is faster.",
     kOfPhotometry},
    {"dye", Text{}, kOfCommand, "Dye of a coloured lens.", kOfPhotometry}};

// Keys of the tables [analysis] and [machining], with their words and conditions.

constexpr Words kRayEngineWords = {"auto", "montecarlo", "cell", "embree"};
constexpr Words kCutoffEngineWords = {"auto", "exact", "montecarlo", "cell", "embree"};
constexpr Condition kOfRays[] = {is("engine", kRayEngineWords)};
constexpr Condition kOfCutoff[] = {is("engine", kCutoffEngineWords)};
constexpr Row kAnalysisRows[] = {
    {"incidence_deg", Number{kIncidence}, 0.0, "Angle of incidence for quantities without their own `incidence_deg`."},
    {"azimuth_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0,
     "Azimuth of the source for quantities without their own `azimuth_deg`."},
    {"rotation_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0,
     "Rotation of the part about its normal, counter-clockwise as seen from the light. It applies to all optical "
     "quantities."},
    {"engine", Word{raytrace::kEngineNames}, "auto", "Engine, as for `retrace rre --engine`."},
    {"target_error", Number{{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false}}, Computed{"1e-4"},
     "Target error, as for `retrace rre --target-error`. It is allowed only if the study has a quantity of RRE."},
    {"samples", Integer{{.low = 1.0, .high = 0x1p36}}, kNone, "Number of rays, as for `retrace rre --samples`.",
     kOfRays},
    {"cutoff", Number{{.low = 0.0, .high = 1.0, .high_included = false}}, kNone,
     "Cut-off power, as for `retrace rre --cutoff`. Photometry by rays has no cut-off.", kOfCutoff}};

constexpr Words kStrategies = {"two-step", "unidirectional"};
constexpr Words kUnidirectional = {"unidirectional"};
constexpr Words kSurfaces = {"as_designed", "as_cut"};
constexpr Words kLimitsHold = {"hold", "ignore"};
constexpr NumberRange kSane{.low = 1e-6, .high = 1e6};
constexpr NumberRange kSaneOrNone{.low = 0.0, .high = 1e6};
constexpr Condition kFinishing[] = {
    is_not("strategy", kUnidirectional, "not allowed for strategy = \"unidirectional\", which has no finishing cuts")};

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

Value edge_life(const MachiningProcess& process) {
  return process.edge_life_mm ? Value(*process.edge_life_mm) : Value();
}
void set_edge_life(MachiningProcess& process, const Value& value) {
  process.edge_life_mm = std::get<double>(value);
}
Value limits_hold(const MachiningProcess& process) {
  return process.has_limits ? 0.0 : 1.0;
}
void set_limits_hold(MachiningProcess& process, const Value& value) {
  process.has_limits = std::get<double>(value) == 0.0;
}

using Process = MachiningProcess;
constexpr Row kMachiningRows[] = {
    {"machine", Text{"the name of a machine or a machine file"}, kNone,
     "Machine that cuts the prisms: the name of a shipped machine (`\"ideal\"`, `\"paper\"`, `\"thesis\"`), or a "
     "[machine file](machine_file.md), relative to the folder of the study. A name with an extension is a file. "
     "Machining times are then those of the plan of `retrace fabricate`.",
     access<&Process::machine>},
    {"process", Text{"the name of a process or a process file"}, kNone,
     "Process that gives the values of the other keys unless they are given here: the name of a shipped process, or a "
     "process file, relative to the folder of the study. A name with an extension is a file.",
     access<&Process::process>},
    {"tool_width_mm", Number{kSane}, Computed{"the element's width"},
     "Width of the tool. An element wider than the tool needs several passes.", access_by<tool_width, set_tool_width>},
    {"clearance_um", Number{kSaneOrNone}, 200.0,
     "Distance between the tool and the face of the workpiece before each cut, perpendicular to the face.",
     access<&Process::clearance_um>},
    {"roughing_depth_um", Number{kSane}, 15.0, "Depth of each roughing cut.", access<&Process::roughing_depth_um>},
    {"finishing_depth_um", Number{kSaneOrNone}, 5.0, "Depth of each finishing cut.",
     access<&Process::finishing_depth_um>},
    {"finishing_cuts", Integer{{.low = 0.0, .high = 1000.0}}, 2.0, "Number of finishing cuts of each facet.",
     access<&Process::finishing_cuts>, kFinishing},
    {"plough_length_um", Number{kSaneOrNone}, 100.0, "Length of the ploughing motion that follows every roughing cut.",
     access<&Process::plough_length_um>},
    {"roughing_feed_mm_per_min", Number{kSane}, 50.0, "Feed of roughing cuts.",
     access<&Process::roughing_feed_mm_per_min>},
    {"finishing_feed_mm_per_min", Number{kSane}, 20.0, "Feed of finishing cuts.",
     access<&Process::finishing_feed_mm_per_min>},
    {"traverse_feed_mm_per_min", Number{kSane}, 200.0, "Feed of motions between cuts.",
     access<&Process::traverse_feed_mm_per_min>},
    {"dwell_s", Number{{.low = 0.0, .high = 3600.0}}, 0.1, "Dwell time at every root.", access<&Process::dwell_s>},
    {"strategy", Word{kStrategies}, "two-step", "Cutting strategy. `\"unidirectional\"` has no finishing cuts.",
     access_by<strategy, set_strategy>},
    {"edge_radius_um", Number{{.low = 0.0, .high = 1000.0}}, Computed{"the design's `surface.root_radius_um`"},
     "Radius of the tool's cutting edge. It is also the radius of the roots, unless the design or the study gives "
     "`surface.root_radius_um`.",
     access<&Process::edge_radius_um>},
    {"edge_life_mm", Number{{.low = 0.0, .low_included = false, .high = fabrication::kMaxEdgeLifeMm}}, kNone,
     "Tool life of an edge: its maximum path length in the material. It has an effect only together with `machine`.",
     access_by<edge_life, set_edge_life>},
    {"limits", Word{kLimitsHold}, "hold",
     "Limits of the tool and the machine in `retrace optimize`. `\"hold\"`: the tool fits the elements "
     "(`tool_fit_mm` >= 0, if `tool_width_mm` is given), the axes reach all facets (`machine_travel_mm` >= 0, with "
     "`machine`), and an edge lasts for an element (`edge_life_margin_mm` >= 0, with `edge_life_mm`). A "
     "`[[constraint]]` on one of these quantities replaces its limit. `\"ignore\"`: no such limits.",
     access_by<limits_hold, set_limits_hold>},
    {"surface", Word{kSurfaces}, "as_designed",
     "Surface of the facets. `\"as_designed\"`: the values of the design. `\"as_cut\"`: facets have the published "
     "roughness and waviness of the strategy, and roots have the radius of the cutting edge. Values from `--set` and "
     "from parameters of the study take precedence over these values.",
     access_by<surface, set_surface>}};

// Keys of the sweep, the tolerance study and the optimization, with their words and conditions.

constexpr Words kCombinations = {"grid", "zipped", "sobol", "latin_hypercube", "monte_carlo"};
constexpr Words kSampled = {"sobol", "latin_hypercube", "monte_carlo"};
constexpr Condition kOfSampled[] = {
    is("combine", kSampled, "only allowed for sweep.combine = \"sobol\", \"latin_hypercube\" or \"monte_carlo\"")};
constexpr Row kSweepRows[] = {
    {"combine", Word{kCombinations}, "grid",
     "Method by which the values of the parameters are combined into points. `\"grid\"`: all combinations; the last "
     "parameter varies fastest. `\"zipped\"`: the first values of all parameters, then their second values, and so on. "
     "`\"sobol\"`: Owen-scrambled Sobol points; their number should be a power of two. `\"latin_hypercube\"`: a Latin "
     "hypercube. `\"monte_carlo\"`: independent random points."},
    {"samples", Integer{{.low = 1.0, .high = 1'000'000.0}}, kRequired, "Number of points.", kOfSampled}};

constexpr Words kSenses = {"max", "min"};
constexpr FormerWord kFormerSenses[] = {{"most", "max"}, {"least", "min"}};
constexpr Word kSense{.words = kSenses, .former = kFormerSenses};
constexpr std::string_view kQuantityOrWeights = "a quantity or a table of weights";
constexpr std::string_view kObjective =
    "Objective: a quantity, or a table of weights such as `{rre = 1, machining_time_h = -0.001}`. With a table, the "
    "objective is the weighted sum.";
constexpr Words kRoundings = {"drawing", "none"};
constexpr Row kOptimiseRows[] = {
    {"maximize", Text{kQuantityOrWeights}, kNone, kObjective},
    {"maximize", ByName{Number{}, {}, kQuantityOrWeights}, kNone, kObjective},
    {"minimize", Text{kQuantityOrWeights}, kNone, kObjective},
    {"minimize", ByName{Number{}, {}, kQuantityOrWeights}, kNone, kObjective},
    {"front", ByName{kSense, {}, "a table such as {rre = \"max\", machining_time_h = \"min\"}"},
     Computed{"the quantities of the objective"},
     "Axes of the Pareto front: quantities, and whether large values (`\"max\"`) or small values (`\"min\"`) are "
     "better."},
    {"scan", Integer{{.low = 3.0, .high = 100'000.0}}, 65.0,
     "Number of designs in the first scan, for each combination of discrete values. For one continuous parameter, the "
     "designs are equally spaced from end to end of its interval. For several continuous parameters, they are the "
     "corners of the intervals and Sobol points. Sizes of prisms are changed to the nearest sizes with which the part "
     "contains whole prisms only."},
    {"rounding", Word{kRoundings}, "drawing",
     "Rounding of continuous parameters in the result. `\"drawing\"`: the values with the fewest digits whose "
     "objective cannot be distinguished from the best one, preferably sizes with which the part contains whole "
     "elements only. `\"none\"`: no rounding."},
    {"bands_of", Texts{}, kNone,
     "Keys of the design, or keys of parameters of the study, for which tolerance bands are computed."},
    {"band_loss_percent", Number{{.low = 0.0, .low_included = false, .high = 100.0}}, 1.0,
     "Relative loss of the first quantity of the objective at which a tolerance band ends."}};
constexpr Words kObjectives = {"maximize", "minimize"};
constexpr Rule kOptimiseRules[] = {
    OneOf{kObjectives, "either maximize or minimize is required: a quantity or a table of weights"}};

constexpr Words kIndices = {"none", "sobol"};
constexpr Row kToleranceRows[] = {
    {"samples", Integer{{.low = 2.0, .high = 1'000'000.0}}, 256.0,
     "Number of rows. With Sobol indices, a row consists of two random parts and one more point for each parameter. "
     "Without indices, a row is one random part."},
    {"sampling", Word{kSampled}, "sobol", "Method by which the rows are sampled."},
    {"indices", Word{kIndices}, "sobol",
     "Sensitivity indices. `\"sobol\"`: Sobol indices, which show how much each parameter contributes to the spread."},
    {"confidence_percent", Number{{.low = 50.0, .high = 99.99}}, 95.0, "Confidence level of all intervals."},
    renamed("least_yield_percent", Row{"min_yield_percent", Number{kPercent}, kNone,
                                       "Minimum yield. If the yield is below it, the command ends with exit code 1."})};

constexpr Words kOver = {"cell", "part"};
constexpr Row kConstraintRows[] = {
    {"quantity", Text{"a quantity of the study"}, kRequired, "Quantity to which the constraint applies."},
    {"min", Number{}, kNone, "Minimum allowed value of the quantity."},
    {"max", Number{}, kNone, "Maximum allowed value of the quantity."},
    {"over", Word{kOver}, "cell",
     "Scope of the constraint in `retrace compose`. `\"cell\"`: each cell must satisfy the constraint, otherwise it "
     "does not belong to the family. `\"part\"`: the mean over the part must satisfy it."}};

constexpr Row kComposeRows[] = {
    {"maximize", TextOrTexts{"a quantity of the study, or a list of them"}, kRequired,
     "Goals: the quantities whose minimum is maximised. A name also selects the quantities with this name and numbers: "
     "`\"margin\"` selects `margin.1`, `margin.1.1`, ... Each goal must be a mean over the area, and not the minimum "
     "of several points, rotations or directions."},
    renamed("least", Row{"min_goal", Number{}, Computed{"0 if all goals are margins"},
                         "Value that the minimum of all goals must reach. If the best part does not reach it, the "
                         "command ends with exit code 1."}),
    renamed("most_zones", Row{"max_zones", Integer{{.low = 1.0, .high = 100.0}}, kNone,
                              "Maximum number of zones. Each zone has one kind of cell."}),
    renamed("least_share", Row{"min_area_fraction", Number{{.low = 0.0, .high = 1.0}}, 0.0,
                               "Minimum fraction of the area for each zone of the part."}),
    renamed("most_share", Row{"max_area_fraction", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, 1.0,
                              "Maximum fraction of the area for each zone."}),
    {"area_fraction_step", Number{{.low = 0.001, .high = 0.5}},
     Computed{"the largest of 0.1, 0.05, 0.02, ... 0.001 that lowers the merit by less than its standard error"},
     "Step of the area fractions of the best part, such as 0.01 or 0.05: each fraction is a multiple of it."},
    {"price", ByName{Number{}, {}, "a table of prices such as {machining_time_h = 0.01}"}, kNone,
     "Prices of quantities. The merit of a part is the minimum of all goals, minus the price for each unit of the "
     "quantity's mean over the part."},
    {"front", ByName{kSense, {}, "a table of one quantity, such as {machining_time_h = \"min\"}"}, kNone,
     "Quantity whose mean over the part is one axis of the Pareto front, and whether large values (`\"max\"`) or small "
     "values (`\"min\"`) are better. The minimum of all goals is the other axis."},
    {"scan", Integer{{.low = 3.0, .high = 100'000.0}}, 65.0,
     "Number of cells in the first scan, for each combination of discrete values. The cells are chosen in the same way "
     "as the designs of `scan` in [optimize]."},
    {"rounds", Integer{{.low = 0.0, .high = 100.0}}, 4.0,
     "Maximum number of searches for further cells with dual prices."},
    {"starts", Integer{{.low = 1.0, .high = 100.0}}, 3.0,
     "Number of cells from which each search with dual prices starts."},
    renamed("looks", Row{"evaluations_per_start", Integer{{.low = 1.0, .high = 10'000.0}}, 20.0,
                         "Maximum number of cells that are evaluated from each start."}),
    {"cell_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, kNone,
     "Standard deviation, from cell to cell, of the error of each angle between facets. These errors average out over "
     "a zone."},
    {"zone_sigma_arcmin", Number{{.low = 0.0, .high = 60.0}}, kNone,
     "Standard deviation, from zone to zone, of the error of each angle between facets. These errors do not average "
     "out. If `cell_sigma_arcmin` or `zone_sigma_arcmin` is given, even as 0, the effects of angle errors on the part "
     "are reported."},
    {"parts", Integer{{.low = 16.0, .high = 16'384.0}}, 1024.0,
     "Number of random parts with angle errors from which the yield is computed."},
    renamed("worst_share",
            Row{"worst_fraction", Number{{.low = 0.0, .low_included = false, .high = 1.0}}, kNone,
                "Fraction of the random parts that counts as the worst, such as 0.05 for one in twenty. In addition to "
                "the best part, a part is reported that is optimized for these worst random parts."})};

constexpr Row kRootRows[] = {{"title", Text{}, kNone, "Title of the study in results."},
                             {"design", File{"a design file"}, kNone,
                              "Design that is varied. Its path is relative to the folder of the study."}};
const Table kTables[] = {
    {.name = "parameter",
     .meaning = "Parameter that is varied.",
     .rows = kParameterRows,
     .presence = Presence::list,
     .shape = "one or more tables [[parameter]]"},
    {.name = "quantity",
     .meaning = "Quantity that is computed for every design.",
     .rows = kQuantityRows,
     .presence = Presence::list,
     .shape = "one or more tables [[quantity]]"},
    {.name = "analysis",
     .meaning = "Settings for the computation of quantities.",
     .rows = kAnalysisRows,
     .presence = Presence::implied},
    {.name = "machining",
     .meaning = "Process in which prisms are cut. The defaults are those of published samples in acrylic.",
     .rows = kMachiningRows,
     .presence = Presence::implied},
    {.name = "sweep",
     .meaning = "Method by which the values of parameters are combined into points.",
     .rows = kSweepRows,
     .presence = Presence::implied},
    {.name = "optimize",
     .meaning = "Objective and settings of an optimization.",
     .rows = kOptimiseRows,
     .rules = kOptimiseRules,
     .presence = Presence::optional},
    {.name = "compose",
     .meaning = "Goals and settings for the best composition of a part from cells.",
     .rows = kComposeRows,
     .presence = Presence::optional},
    {.name = "constraint",
     .meaning = "Constraint that a good design or part must satisfy.",
     .rows = kConstraintRows,
     .presence = Presence::list,
     .shape = "one or more tables [[constraint]]"},
    {.name = "tolerance",
     .meaning = "Settings for random parts with errors of manufacture.",
     .rows = kToleranceRows,
     .presence = Presence::implied}};

const Table kRoot = {.name = "",
                     .meaning = "Parameters that are varied, and quantities that are computed.",
                     .rows = kRootRows,
                     .tables = kTables};
const Format kFormat = {"study", "retrace.study/1", "Study of a design", kRoot, true};

}  // namespace

const Format& study_format() {
  return kFormat;
}

std::string_view current_kind(std::string_view kind) {
  for (const FormerWord& word : kFormerKinds)
    if (word.former == kind) return word.current;
  return kind;
}

}  // namespace retrace::studies
