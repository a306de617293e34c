#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/image_options.h"

namespace retrace::app {

/// Options that every command has.
struct CommonOptions {
  std::string json;  ///< file for the JSON document; "-" is standard output; empty: none
  std::string out;   ///< output folder; empty: none
  std::optional<unsigned> threads;
  std::uint32_t seed = 1;
  std::vector<std::string> overrides;  ///< --set key=value
  bool quiet = false;
};

struct RreOptions {
  std::vector<std::string> designs;
  std::string incidence = "0";
  std::string azimuth = "0";
  std::string engine = "auto";
  std::string sampling = "stratified";
  std::optional<std::uint64_t> samples;
  std::optional<double> target_error;
  std::optional<double> cutoff;
  bool derivatives = false;
  bool footprint = false;
  bool far_field = false;
};

struct RoughnessOptions {
  std::string design;
  std::string sa = "0,2,5,10,15,20,30,40,50,75,100,150,200";
  std::string correlation_length_um = "5,20,50";
  double waviness_length_um = 200.0;
  std::vector<std::string> facets;  ///< tables; none: the shipped ones
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  std::optional<std::uint64_t> samples;
  double target_error = 1e-3;
};

struct PhotometryOptions {
  std::string design;
  std::string standard;
  std::optional<std::string> part_class;
  std::optional<std::string> colour;
  std::optional<double> area_cm2;
  std::optional<std::string> rotation;
  std::optional<std::string> dye;
  std::optional<double> source_arcmin;
  std::optional<double> receiver_arcmin;
  double window_deg = 2.0;
  std::string light = "a";
  std::string engine = "auto";
  std::uint64_t samples = 1U << 20;
  std::optional<double> cutoff;
  bool no_diffraction = false;
  bool no_advice = false;
};

struct MetrologyOptions {
  std::string file;
  std::string form = "plane";
  double cutoff_um = 80.0;
  std::optional<std::string> pixel_um;  ///< one number, or two with a comma between
  std::optional<std::string> height_unit;
  std::optional<std::string> lateral_unit;
  std::optional<std::size_t> channel;
  std::optional<double> feed_mm_per_min;
  bool edge = false;
};

/// Of commands that keep their points in a store.
struct StudyOptions {
  std::string study;
  bool resume = false;
  bool overwrite = false;
  std::string job;  ///< optimize: job file to write of the chosen design, with JobOptions; empty: none
};

struct JobOptions {
  std::string design;
  std::string machine = "ideal";
  std::optional<double> tool_width_mm;  ///< job: required; optimize: otherwise that of the study
  std::string strategy = "two-step";
  std::string process = "thesis-acrylic";
  std::string workpiece = "mould";
  double shrinkage_percent = 0.0;
  std::string reachable;  ///< job: design file of what a chisel makes of cube corners; empty: none
};

struct FabricateOptions {
  std::string job;
  std::string dialect = "rs274ngc";
  std::string phase = "all";
  std::optional<std::int64_t> from_element;
  std::optional<std::int64_t> stop_every;
  std::optional<double> split_hours;
};

struct VerifyOptions {
  std::string job;
  std::vector<std::string> programs;
  std::string dialect = "auto";
  double tolerance_nm = 10.0;
  std::string as_machined;  ///< design file to write; empty: none
  std::string map;          ///< PNG to write; empty: none
};

struct ForcesOptions {
  std::string job;
  std::string configuration = "isolated";
  std::uint64_t facet = 1;
  std::optional<double> plunge_mm;
};

struct ExportOptions {
  std::string design;
  std::string file;  ///< the same as --out
  std::string what = "array";
  std::optional<double> block_mm;
};

struct ReportOptions {
  std::string folder;
  std::string title;  ///< empty: that of the design
};

/// What the user typed.
struct CommandLine {
  std::string command;
  CommonOptions common;
  RreOptions rre;
  RoughnessOptions roughness;
  PhotometryOptions photometry;
  MetrologyOptions metrology;
  StudyOptions study;
  JobOptions job;
  FabricateOptions fabricate;
  VerifyOptions verify;
  ForcesOptions forces;
  std::string turn_part;
  ImageOptions image;
  ExportOptions solid;
  ReportOptions report;
  std::string design;  ///< inspect
  std::string kind;    ///< init
  std::string what;    ///< list, schema; empty: the formats
};

/// Reads the command line. Nothing is returned if help or the version was asked for: that is printed.
/// \throw InputError for a usage error
std::optional<CommandLine> read_command_line(int argc, const char* const* argv);

}  // namespace retrace::app
