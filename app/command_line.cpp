#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>

#include "app/output.h"
#include "core/error.h"
#include "core/version.h"

namespace retrace::app {
namespace {

/// Whole numbers in decimal: CLI11 alone would read 010 as eight.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number =
        error == std::errc{} && end == text.data() + text.size() && (text.size() == 1 || text.front() != '0');
    if (is_number && value >= low && value <= high) return {};
    return fmt::format("must be a whole number from {} to {}, got {}", low, high, text);
  };
  return {check, "", "WHOLE"};
}

CLI::Validator real_number() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) return {};
    return fmt::format("must be a number, got {}", text);
  };
  return {check, "", "REAL"};
}

/// An empty name is what an unset variable of the shell leaves: better refused than taken for no name.
CLI::Validator not_empty() {
  return {[](const std::string& text) { return text.empty() ? "must not be empty" : ""; }, "", "NAME"};
}

void add_common(CLI::App& app, CommonOptions& common) {
  app.add_option("--json", common.json, "write the result as JSON to FILE; - is standard output")
      ->type_name("FILE")
      ->check(not_empty());
  app.add_option("-o,--out", common.out, "write the result's files to folder DIR (init, job, export: to file FILE)")
      ->type_name("DIR")
      ->check(not_empty());
  app.add_option("--threads", common.threads, "threads to use [all cores the process may use]")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  app.add_option("--seed", common.seed, "seed of the random numbers")
      ->type_name("S")
      ->capture_default_str()
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()));
  app.add_option("--set", common.overrides, "override a key of the design, such as element.base_mm=0.4")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--quiet", common.quiet, "no progress bar, no table, no remarks");
  app.set_version_flag("--version", std::string("retrace ") + kVersion, "show the version and leave");
  app.set_help_flag("-h,--help", "show this help and leave");
}

void add_rre(CLI::App& app, RreOptions& rre) {
  CLI::App* command = app.add_subcommand("rre", "retroreflective efficiency against angle");
  command->add_option("DESIGN", rre.designs, "design files; - is standard input")->required()->check(not_empty());
  command
      ->add_option("--incidence", rre.incidence,
                   "incidence angles in degrees: a,b,c, start:stop:step and start:stop:auto")
      ->type_name("LIST")
      ->capture_default_str();
  command->add_option("--azimuth", rre.azimuth, "azimuths of the source in degrees: a,b,c and start:stop:step")
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option("--engine", rre.engine,
                   "exact, montecarlo (cell or embree), or auto: the faster one for each direction")
      ->type_name("ENGINE")
      ->capture_default_str();
  auto* samples =
      command->add_option("--samples", rre.samples, "rays for each point [until the target error is reached]")
          ->type_name("N")
          ->check(whole_number(1, std::uint64_t{1} << 36));
  command
      ->add_option("--sampling", rre.sampling, "stratified, or plain: random points and no splitting, to compare with")
      ->type_name("KIND")
      ->capture_default_str();
  command
      ->add_option("--target-error", rre.target_error,
                   "standard error of RRE to reach, and most that exact may leave truncated, as a fraction "
                   "[0.0001; --engine exact: 1e-10]")
      ->type_name("E")
      ->check(real_number())
      ->excludes(samples);
  command
      ->add_option(
          "--cutoff", rre.cutoff,
          "least power that is followed, as a share of the incident power [1e-10; exact: as the target error asks]")
      ->type_name("W")
      ->check(real_number());
  command->add_flag("--derivatives", rre.derivatives, "of RRE by the parameters of the design (--engine exact)");
  command->add_flag("--footprint", rre.footprint,
                    "which regions of the entrance face send light back, as polygons (--engine exact, --out)");
  command->add_flag("--far-field", rre.far_field,
                    "the directions in which light leaves the entrance face (--engine exact, --out)");
}

void add_roughness(CLI::App& app, RoughnessOptions& roughness) {
  CLI::App* command = app.add_subcommand("roughness", "retroreflective efficiency against the roughness of the facets");
  command->add_option("DESIGN", roughness.design, "design file; - is standard input")->required()->check(not_empty());
  command->add_option("--sa", roughness.sa, "Sa of the curves in nm: a,b,c and start:stop:step")
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option("--correlation-length-um", roughness.correlation_length_um,
                   "one curve each; measured facets have the first")
      ->type_name("LIST")
      ->capture_default_str();
  command->add_option("--waviness-length-um", roughness.waviness_length_um, "period of the waviness of measured facets")
      ->type_name("L")
      ->capture_default_str()
      ->check(real_number());
  command->add_option("--facets", roughness.facets, "table of measured facets, repeatable [the shipped ones]")
      ->type_name("FILE")
      ->take_all()
      ->allow_extra_args(false)
      ->check(not_empty());
  command->add_option("--incidence", roughness.incidence_deg, "angle of incidence in degrees")
      ->type_name("T")
      ->capture_default_str()
      ->check(real_number());
  command->add_option("--azimuth", roughness.azimuth_deg, "azimuth of the source in degrees")
      ->type_name("P")
      ->capture_default_str()
      ->check(real_number());
  auto* samples =
      command->add_option("--samples", roughness.samples, "rays for each point [until the target error is reached]")
          ->type_name("N")
          ->check(whole_number(1, std::uint64_t{1} << 36));
  command->add_option("--target-error", roughness.target_error, "standard error of RRE to reach, as a fraction")
      ->type_name("E")
      ->capture_default_str()
      ->check(real_number())
      ->excludes(samples);
}

void add_photometry(CLI::App& app, PhotometryOptions& photometry) {
  CLI::App* command = app.add_subcommand("photometry", "coefficients of retroreflection against a standard");
  command->add_option("DESIGN", photometry.design, "design file; - is standard input")->required()->check(not_empty());
  command->add_option("--standard", photometry.standard, "r150, j594, bicycle, or a limits file")
      ->type_name("NAME|FILE")
      ->required()
      ->check(not_empty());
  command->add_option("--class", photometry.part_class, "class of the part, such as IA [the only one there is]")
      ->type_name("CLASS");
  command->add_option("--colour", photometry.colour, "white, amber, red, ... [the only one there is]")
      ->type_name("COLOUR");
  command->add_option("--area-cm2", photometry.area_cm2, "area of the part that the design shows the make of")
      ->type_name("A")
      ->required()
      ->check(real_number());
  command
      ->add_option("--rotation", photometry.rotation,
                   "turns of the part about its normal in degrees; the least value counts [the standard's]")
      ->type_name("LIST");
  command
      ->add_option(
          "--dye", photometry.dye,
          "none, red, amber (illustrative) or a file [by the colour, unless the design's absorption is spectral]")
      ->type_name("NAME|FILE")
      ->check(not_empty());
  command->add_option("--source-arcmin", photometry.source_arcmin, "diameter of the source [the standard's]")
      ->type_name("D")
      ->check(real_number());
  command->add_option("--receiver-arcmin", photometry.receiver_arcmin, "diameter of the receiver [the standard's]")
      ->type_name("D")
      ->check(real_number());
  command->add_option("--window-deg", photometry.window_deg, "half angle of the far field that is computed")
      ->type_name("W")
      ->capture_default_str()
      ->check(real_number());
  command->add_option("--light", photometry.light, "a: CIE A as the eye sees it; design: what the design says")
      ->type_name("LIGHT")
      ->capture_default_str();
  command->add_option("--engine", photometry.engine, "exact, montecarlo (embree), or auto: exact where it serves")
      ->type_name("ENGINE")
      ->capture_default_str();
  command->add_option("--samples", photometry.samples, "rays for each direction, by Monte Carlo")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(1, std::uint64_t{1} << 36));
  command
      ->add_option("--cutoff", photometry.cutoff,
                   "exact: least power that is followed, as a share of what falls on an element [1e-6]")
      ->type_name("W")
      ->check(real_number());
  command->add_flag("--no-diffraction", photometry.no_diffraction, "geometric far field alone");
  command->add_flag("--no-advice", photometry.no_advice, "do not look for what to change if a point fails");
}

void add_metrology(CLI::App& app, MetrologyOptions& metrology) {
  CLI::App* command = app.add_subcommand("metrology", "roughness, waviness and edge radius of a measured surface");
  command->add_option("FILE", metrology.file, "height map or profile: text, SDF, GSF or GWY")
      ->required()
      ->check(not_empty());
  command->add_option("--form", metrology.form, "form to remove: none, plane or poly2 to poly8")
      ->type_name("FORM")
      ->capture_default_str();
  command
      ->add_option("--cutoff-um", metrology.cutoff_um, "cut-off of the Gaussian filter between roughness and waviness")
      ->type_name("L")
      ->capture_default_str()
      ->check(real_number());
  command->add_option("--pixel-um", metrology.pixel_um, "spacing of the points, or PX,PY [what the file says]")
      ->type_name("P");
  command
      ->add_option("--height-unit", metrology.height_unit, "of the heights: m, mm, um, nm or pm [what the file says]")
      ->type_name("UNIT");
  command
      ->add_option("--lateral-unit", metrology.lateral_unit, "of lengths without a unit, likewise [what the file says]")
      ->type_name("UNIT");
  command->add_option("--channel", metrology.channel, "channel of a GWY file [the first]")
      ->type_name("N")
      ->check(whole_number(0, 999999));
  command->add_option("--feed-mm-per-min", metrology.feed_mm_per_min, "feed of the cut, for waves in Hz")
      ->type_name("F")
      ->check(real_number());
  command->add_flag("--edge", metrology.edge, "rows are profiles across an edge: fit its radius and chamfer");
}

CLI::App* add_study(CLI::App& app, StudyOptions& study, const char* name, const char* what) {
  CLI::App* command = app.add_subcommand(name, what);
  command->add_option("STUDY", study.study, "study file; - is standard input")->required()->check(not_empty());
  auto* resume = command->add_flag("--resume", study.resume, "go on with the store that is in the output folder");
  command->add_flag("--overwrite", study.overwrite, "replace the store that is in the output folder")->excludes(resume);
  return command;
}

/// How a job is made, for every command that makes one. \return the options
std::vector<CLI::Option*> add_making(CLI::App& command, JobOptions& job) {
  std::vector<CLI::Option*> options;
  options.push_back(command.add_option("--machine", job.machine, "ideal, paper, thesis, ideal-dmc or a file")
                        ->type_name("MACHINE")
                        ->capture_default_str()
                        ->check(not_empty()));
  options.push_back(
      command.add_option("--tool-width-mm", job.tool_width_mm, "width of the tool's edge, 0.1 to 2; of dmc 0.01 to 10")
          ->type_name("W")
          ->check(real_number()));
  options.push_back(
      command.add_option("--strategy", job.strategy, "unidirectional, bidirectional or two-step; dmc for cube corners")
          ->type_name("STRATEGY")
          ->capture_default_str());
  options.push_back(
      command.add_option("--process", job.process, "depths, feeds and dwells: a shipped process or a file")
          ->type_name("PROCESS")
          ->capture_default_str()
          ->check(not_empty()));
  options.push_back(command.add_option("--workpiece", job.workpiece, "mould, or direct: the optic itself is cut")
                        ->type_name("KIND")
                        ->capture_default_str());
  options.push_back(
      command.add_option("--shrinkage-percent", job.shrinkage_percent, "by which the mould is larger than the part")
          ->type_name("S")
          ->capture_default_str()
          ->check(real_number()));
  return options;
}

void add_job(CLI::App& app, JobOptions& job) {
  CLI::App* command = app.add_subcommand("job", "a fabrication job from a design");
  command->add_option("DESIGN", job.design, "design file; - is standard input")->required()->check(not_empty());
  add_making(*command, job);
  command->get_option("--tool-width-mm")->required();
  command
      ->add_option("--reachable", job.reachable,
                   "write what a chisel with a straight edge makes of cube corners, as a design, instead of a job")
      ->type_name("FILE")
      ->check(not_empty());
}

void add_optimize(CLI::App& app, StudyOptions& study, JobOptions& job) {
  CLI::App* command = add_study(app, study, "optimize", "the best design within constraints, as a study file says");
  CLI::Option* const file = command->add_option("--job", study.job, "write the fabrication job of the chosen design")
                                ->type_name("FILE")
                                ->check(not_empty());
  for (CLI::Option* const option : add_making(*command, job)) option->needs(file);
}

void add_fabricate(CLI::App& app, FabricateOptions& fabricate) {
  CLI::App* command = app.add_subcommand("fabricate", "NC programs, tool path and time of a fabrication job");
  command->add_option("JOB", fabricate.job, "job file, as retrace job writes it")->required()->check(not_empty());
  command->add_option("--dialect", fabricate.dialect, "rs274ngc, sinumerik, fanuc or pmac")
      ->type_name("DIALECT")
      ->capture_default_str();
  command
      ->add_option(
          "--phase", fabricate.phase,
          "roughing, finishing, one stage such as finishing-1-facet-2, or that stage and all after it with a +")
      ->type_name("PHASE")
      ->capture_default_str();
  command->add_option("--from-element", fabricate.from_element, "start at that element's first visit [the first]")
      ->type_name("N")
      ->check(whole_number(0, std::numeric_limits<std::int32_t>::max()));
  command->add_option("--stop-every", fabricate.stop_every, "optional stop after every N visits [none]")
      ->type_name("N")
      ->check(whole_number(1, std::numeric_limits<std::int32_t>::max()));
  command->add_option("--split-hours", fabricate.split_hours, "programs of at most so many hours [one program]")
      ->type_name("H")
      ->check(real_number());
}

void add_verify(CLI::App& app, VerifyOptions& verify) {
  CLI::App* command = app.add_subcommand("verify", "what NC programs really cut, against their fabrication job");
  command->add_option("JOB", verify.job, "job file")->required()->check(not_empty());
  command->add_option("PROGRAM", verify.programs, "NC programs, in the order in which they run")
      ->required()
      ->check(not_empty());
  command->add_option("--dialect", verify.dialect, "rs274ngc, sinumerik, fanuc or pmac, or auto: told from the text")
      ->type_name("DIALECT")
      ->capture_default_str();
  command->add_option("--tolerance-nm", verify.tolerance_nm, "that facet planes may differ from the design by")
      ->type_name("T")
      ->capture_default_str()
      ->check(real_number());
  command->add_option("--map", verify.map, "draw what the programs leave over the facets to a PNG FILE")
      ->type_name("FILE")
      ->check(not_empty());
  command->add_option("--as-machined", verify.as_machined, "write the part that is left as a design to FILE")
      ->type_name("FILE")
      ->check(not_empty());
}

void add_forces(CLI::App& app, ForcesOptions& forces) {
  CLI::App* command = app.add_subcommand("forces", "cutting forces of a fabrication job over one cycle");
  command->add_option("JOB", forces.job, "job file")->required()->check(not_empty());
  command
      ->add_option("--configuration", forces.configuration,
                   "isolated: between walls that rub, or orthogonal: with the edge alone")
      ->type_name("WORD")
      ->capture_default_str();
  command->add_option("--facet", forces.facet, "of a bidirectional job: 1 or 2")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(1, 2));
  command->add_option("--plunge-mm", forces.plunge_mm, "length of the plunge [that of the last cut]")
      ->type_name("L")
      ->check(real_number());
}

void add_plane(CLI::App& app, FabricateOptions& plane) {
  CLI::App* command = app.add_subcommand("plane", "NC programs of a flat lens of zones, planed or turned");
  command->add_option("PART", plane.job, "part file")->required()->check(not_empty());
  command->add_option("--dialect", plane.dialect, "rs274ngc, sinumerik, fanuc or pmac")
      ->type_name("DIALECT")
      ->capture_default_str();
}

void add_export(CLI::App& app, ExportOptions& solid) {
  CLI::App* command = app.add_subcommand("export", "a design's solid as STL, OBJ or STEP");
  command->add_option("DESIGN", solid.design, "design file; - is standard input")->required()->check(not_empty());
  command->add_option("FILE", solid.file, "file to write: .stl, .obj, .step or .stp; the same as --out FILE")
      ->check(not_empty());
  command->add_option("--what", solid.what, "element, array or mould: the block behind the part's back")
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_option("--block-mm", solid.block_mm, "of a mould, below its deepest point [the plate's thickness]")
      ->type_name("T")
      ->check(real_number());
}

void add_report(CLI::App& app, ReportOptions& report) {
  CLI::App* command = app.add_subcommand("report", "one self-contained HTML page of a folder of results");
  command->add_option("DIR", report.folder, "folder that other commands wrote with --out")
      ->required()
      ->check(not_empty());
  command->add_option("--title", report.title, "of the page [that of the design]")->type_name("TEXT");
}

/// What to say if a command or what it needs is missing: a word that nobody knows explains it better.
std::string missing(const CLI::App& app, const std::string& otherwise) {
  const std::vector<std::string> unknown = app.remaining(true);
  for (const std::string& word : unknown)
    if (word.starts_with('-')) return "unknown option " + word;
  if (!app.get_subcommands().empty()) return otherwise;
  const std::string commands =
      "rre, inspect, photometry, roughness, metrology, sweep, optimize, tolerance, job, fabricate, verify, forces, "
      "turn, plane, "
      "image, export, report, init, list and schema";
  return unknown.empty() ? "a command is required: there are " + commands
                         : fmt::format("unknown command {}: there are {}", unknown.front(), commands);
}

/// CLI11 words its errors over several lines at times.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

std::optional<CommandLine> read_command_line(int argc, const char* const* argv) {
  CommandLine line;
  CLI::App app("retrace: what a retroreflector array sends back, from its design file", "retrace");
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(34);
  add_common(app, line.common);
  add_rre(app, line.rre);
  app.add_subcommand("inspect", "what a design is: counts, areas, limits of total reflection; its drawings")
      ->add_option("DESIGN", line.design, "design file; - is standard input")
      ->required()
      ->check(not_empty());
  add_photometry(app, line.photometry);
  add_roughness(app, line.roughness);
  add_metrology(app, line.metrology);
  add_study(app, line.study, "sweep", "designs and directions over ranges, as a study file says");
  add_job(app, line.job);
  add_fabricate(app, line.fabricate);
  add_optimize(app, line.study, line.job);
  add_study(app, line.study, "tolerance", "what becomes of a design in manufacture, as a study file says");
  add_verify(app, line.verify);
  add_forces(app, line.forces);
  app.add_subcommand("turn", "NC programs of a turned freeform, and what they leave")
      ->add_option("PART", line.turn_part, "part file")
      ->required()
      ->check(not_empty());
  add_plane(app, line.fabricate);
  add_image(app, line.image);
  add_export(app, line.solid);
  add_report(app, line.report);
  app.add_subcommand("init", "a commented design or part file to start from")
      ->add_option("KIND", line.kind, "rtp, hexagonal_icc, triangular_icc or round_zone_lens")
      ->required();
  app.add_subcommand("list", "what is shipped")
      ->add_option("WHAT", line.what, "materials, machines, processes or standards")
      ->required();
  app.add_subcommand("schema", "JSON Schema of a file format, for editors and validators")
      ->add_option("FORMAT", line.what, "machine or process [the list of formats]")
      ->check(not_empty());
  for (CLI::App* command : app.get_subcommands({})) {
    command->fallthrough();
    command->footer(
        "Options of every command, before or after it: --json FILE, -o/--out DIR, --threads N [all cores],\n"
        "--seed S [1], --set KEY=VALUE (repeatable), --quiet, --version, --help");
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return std::nullopt;
  } catch (const CLI::CallForVersion&) {
    print(std::string("retrace ") + kVersion + "\n");
    return std::nullopt;
  } catch (const CLI::RequiredError& error) {
    throw InputError(missing(app, one_line(error.what())) + "; see retrace --help");
  } catch (const CLI::ParseError& error) {
    throw InputError(one_line(error.what()) + "; see retrace --help");
  }
  line.command = app.get_subcommands().front()->get_name();
  return line;
}

}  // namespace retrace::app
