#include "fabrication/chisel/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/chisel/plan/process_facts.h"
#include "fabrication/chisel/plan/program_maker.h"
#include "fabrication/chisel/plan/program_text.h"
#include "fabrication/chisel/plan/stages.h"
#include "fabrication/job/substrate_cells.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

/// Returns true if `name` is the name of this stage, or of the group to which the stage belongs ("roughing" or
/// "finishing").
bool is_named(const Stage& stage, std::string_view name) {
  return stage.name == name || (name == "roughing" && stage.roughs) ||
         (name == "finishing" && stage.name.starts_with(name));
}

/// Throws an InputError for a name that is neither a stage nor a group of stages of the job.
[[noreturn]] void refuse_phase(const Plan& plan, Field field, const std::string& name) {
  std::vector<std::string> names;
  for (const Stage& stage : plan.stages) names.push_back(stage.name);
  constexpr std::size_t kMaxNamedStages = 12;
  if (names.size() > kMaxNamedStages) {
    names.resize(kMaxNamedStages);
    names.emplace_back("...");
  }
  const bool is_phase = field.name == "phase";
  throw InputError(
      field, fmt::format("must be {}roughing, finishing or the name of a stage ({}){}, got {}", is_phase ? "all, " : "",
                         fmt::join(names, ", "),
                         is_phase ? ", optionally followed by + to include all later stages" : "", plain(name)));
}

/// Removes all stages from `plan` except the requested ones.
/// \return the stages of the job before the first requested stage
/// \throw InputError for a phase that the job does not have
std::vector<Stage> choose_stages(Plan& plan, const PlanOptions& options) {
  if (!options.before.empty()) {
    const auto first = std::find_if(plan.stages.begin(), plan.stages.end(),
                                    [&](const Stage& stage) { return is_named(stage, options.before); });
    if (first == plan.stages.end()) refuse_phase(plan, Field{"next_stage"}, options.before);
    if (first == plan.stages.begin())
      throw InputError(Field{"next_stage"}, "must not be the first stage of the job, because no stage precedes it");
    plan.stages.erase(first, plan.stages.end());
  }
  if (options.phase == "all") return {};
  const bool and_after = options.phase.ends_with('+');
  const std::string name = options.phase.substr(0, options.phase.size() - (and_after ? 1 : 0));
  std::vector<Stage> chosen;
  std::vector<Stage> before;
  for (const Stage& stage : plan.stages) {
    if ((and_after && !chosen.empty()) || is_named(stage, name)) chosen.push_back(stage);
    if (chosen.empty()) before.push_back(stage);
  }
  if (chosen.empty()) refuse_phase(plan, Field{"phase"}, options.phase);
  plan.stages = std::move(chosen);
  return before;
}

/// Checks the options whose allowed values depend on the job.
/// \param elements number of elements of the job
/// \param passes number of passes of the job
/// \throw InputError that names the option, if its value is out of range
void check_options(const PlanOptions& options, std::size_t elements, std::size_t passes) {
  const auto most = static_cast<std::int64_t>(elements) - 1;
  if (options.from_element && (*options.from_element < 0 || *options.from_element > most))
    throw InputError(Field{"from_element"}, fmt::format("must be 0 to {}, got {}", most, *options.from_element));
  const auto max_passes = static_cast<std::int64_t>(passes);
  if (options.from_pass && (*options.from_pass < 1 || *options.from_pass > max_passes))
    throw InputError(Field{"from_pass"}, fmt::format("must be 1 to {}, got {}", max_passes, *options.from_pass));
}

/// Returns the properties of the cutting process: plunging for prisms, micro chiseling for cube corners.
ProcessFacts facts_of(const Job& job, const Plan& plan) {
  const auto facts = cuts_prisms(job) ? plunging_facts : chiseling_facts;
  return facts(job, plan.stock_mm, plan.elements.size());
}

}  // namespace

Plan make_plan(const Job& job, const Machine& machine, const PlanOptions& options) {
  check_on_machine(job, machine);
  Plan plan;
  plan.elements = cut_elements(job);
  if (job.substrate) plan.stock_mm = stock_mm(job, plan.elements);
  const ProcessFacts facts = facts_of(job, plan);
  check_options(options, plan.elements.size(), facts.passes_mm.size());
  plan.cuts_per_facet = facts.cuts_per_facet;
  const std::vector<RoutineStart> starts = add_stages(job, machine, plan);
  plan.safe_z_mm = safe_height_mm(job, machine, plan.poses);
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    plan.aperture_area_mm2 +=
        geometry::area(geometry::aperture_outline(blank_element(job, zone))) *
        static_cast<double>(job.zones.empty() ? plan.elements.size() : job.zones[zone].apexes_mm.size());
  const std::vector<Stage> stages_before = choose_stages(plan, options);
  make_programs(job, machine, options, facts, starts, stages_before, plan);
  return plan;
}

}  // namespace retrace::fabrication
