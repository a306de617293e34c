#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/swept_volume_sink.h"

// Tests of programs of every strategy in which one line is removed or duplicated, or one number is changed. The chips
// are measured by an independent method: dexel lines normal to the facets, from which each move is subtracted as a
// polyhedron.

namespace retrace::fabrication::test::chip_faults_test {
namespace {

using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

/// Dexel lines normal to one facet of the first element. Each line stores the disjoint intervals that earlier moves
/// have removed.
class DexelFacet {
 public:
  /// \param low_mm lower bounds of the field, measured from the root: along the root, up the facet and along the normal
  /// \param high_mm upper bounds of the field
  /// \param lines number of lines along the longer side
  DexelFacet(const Cavity& groove, std::size_t facet, const Vec3& low_mm, const Vec3& high_mm, std::size_t lines)
      : root_mm_(common(groove).root_mm),
        normal_(common(groove).facets[facet].normal),
        is_cube_(std::holds_alternative<CubeCavity>(groove)),
        box_{low_mm, high_mm},
        lines_(lines) {
    // Axes of the field: z is the normal, and x and y are in the facet.
    const Vec3 y =
        is_cube_ ? std::get<CubeCavity>(groove).edges[(facet + 1) % 3] : common(groove).facets[facet].up_slope;
    from_workpiece_.row(0) = y.cross(normal_).transpose();
    from_workpiece_.row(1) = y.transpose();
    from_workpiece_.row(2) = normal_.transpose();
  }

  struct Chip {
    double length_mm = 0.0;
    double left_mm = 0.0;  ///< height above the facet at which the chip begins
  };

  /// Subtracts the swept volume of a move from the lines, and returns the thickest chip. If the move does not run along
  /// the facet, returns an empty Chip.
  Chip cut(const SweptVolume& sweep, const RigidMotion& pose, const ToolWedge& wedge) {
    RigidMotion from_field;
    from_field.rotation = pose.rotation * from_workpiece_.transpose();
    from_field.translation_mm = pose.point(root_mm_);
    SweptVolume alone = sweep;
    alone.pose = 0;
    const DexelField field = cut_dexels({&alone, 1}, {&from_field, 1}, wedge, box_, 2, lines_);
    taken_.resize(field.removed_mm.size());
    Chip chip;
    for (std::size_t i = 0; i < field.removed_mm.size(); ++i) {
      if (field.removed_mm[i] <= 0.0) continue;
      const double low = field.lowest_mm[i];
      const double high = std::min(low + field.removed_mm[i], face_mm(field, i));
      const double length = take(taken_[i], low, high);
      if (length > chip.length_mm) chip = {length, low};
    }
    const Vec3 travel = pose.rotation.transpose() * (sweep.to_mm - sweep.from_mm);
    const Vec3 looks = pose.rotation.transpose() * wedge.sides[0].outward;
    // True if the move runs along the facet. A V-shaped tool runs along two facets at the same time. Its move is
    // assigned to the facet that its clearance face faces.
    const bool goes_along = std::abs(travel.normalized().dot(normal_)) < 0.02;
    return goes_along && (!is_cube_ || looks.dot(normal_) < -0.9) ? chip : Chip{};
  }

 private:
  /// Returns the height at which a line leaves the blank, whose face is z = 0.
  double face_mm(const DexelField& field, std::size_t i) const {
    const Vec3 size = box_.high_mm - box_.low_mm;
    const double x = (static_cast<double>(i % field.columns) + 0.5) / static_cast<double>(field.columns);
    const double y = (static_cast<double>(i / field.columns) + 0.5) / static_cast<double>(field.rows);
    const Vec3 foot(box_.low_mm.x() + x * size.x(), box_.low_mm.y() + y * size.y(), 0.0);
    const Vec3 p = root_mm_ + from_workpiece_.transpose() * foot;
    return -p.z() / normal_.z();
  }

  /// Adds the interval from `low` to `high` to the disjoint intervals `parts`. Returns the length that is added to
  /// their union.
  static double take(std::vector<std::pair<double, double>>& parts, double low, double high) {
    double length = high - low;
    if (length <= 0.0) return 0.0;
    std::vector<std::pair<double, double>> others;
    for (const auto& part : parts) {
      if (part.second < low || part.first > high) {
        others.push_back(part);
        continue;
      }
      length -= std::min(part.second, high) - std::max(part.first, low);
      low = std::min(low, part.first);
      high = std::max(high, part.second);
    }
    others.emplace_back(low, high);
    parts = others;
    return length;
  }

  Vec3 root_mm_;
  Vec3 normal_;
  bool is_cube_;
  DexelBox box_;
  std::size_t lines_;
  Eigen::Matrix3d from_workpiece_;
  std::vector<std::vector<std::pair<double, double>>> taken_;
};

/// Returns the maximum ratio of chip thickness to depth of cut, by the formulas of docs/theory/verification.md.
double max_chip_ratio(const Job& job) {
  if (job.strategy == Strategy::dmc) {
    const Vec3 spine = v_tool_edges(job.tool).spine;
    return std::max({1.0, spine.z() / spine.x(), spine.z() / spine.y()});
  }
  const double apex = Angle::from_deg(prism_of(job).apex_angle_deg).rad();
  const double rake = Angle::from_deg(job.tool.wedge_deg + job.tool.clearance_deg).rad();
  return std::max(1.0, std::tan(rake) * (1.0 + std::cos(apex)) / std::sin(apex));
}

/// Returns the difference between the thickest chip of a program and its limit, in um.
double true_excess_um(const Job& job, const Machine& m, const std::string& text) {
  SweptVolumeSink moves(m);
  run_nc(parse_nc(text, "p.ngc", NcDialect::rs274ngc), moves);
  const VerificationModel workpiece = verification_model_of(job, m);
  const Cavity& groove = workpiece.cavities.front();
  const ToolWedge wedge = wedge_of(job, m);
  const double length_mm = common(groove).facet_length_mm;
  const double allowance_um = job.strategy == Strategy::two_step || job.strategy == Strategy::dmc
                                  ? job.process.finishing_cuts * job.process.finishing_depth_um
                                  : 0.0;
  std::vector<std::pair<std::size_t, DexelFacet>> fields;
  for (std::size_t f = 0; f < common(groove).facets.size(); ++f) {
    const double top = 3.0 * length_mm;
    if (!cuts_prisms(job)) {
      fields.emplace_back(f, DexelFacet(groove, f, {0.0, 0.0, -0.1 * length_mm}, {length_mm, length_mm, top}, 24));
      continue;
    }
    // One field covers the whole facet. A finer field covers the region close to the root.
    fields.emplace_back(f, DexelFacet(groove, f, {-0.01, 0.0, -0.1}, {0.01, length_mm, top}, 60));
    fields.emplace_back(f, DexelFacet(groove, f, {-0.01, 0.0, -0.1}, {0.01, 0.1, top}, 60));
  }
  double excess_um = -1e9;
  for (std::size_t k = 0; k < moves.sweeps.size(); ++k)
    for (auto& [f, field] : fields) {
      SweptVolume sweep = moves.sweeps[k];
      sweep.from_mm += wedge.tip_mm;
      sweep.to_mm += wedge.tip_mm;
      const DexelFacet::Chip chip = field.cut(sweep, moves.poses[k], wedge);
      const double left_um = 1e3 * chip.left_mm;
      const double depth_um =
          left_um < allowance_um - 0.1 ? job.process.finishing_depth_um : job.process.roughing_depth_um;
      excess_um = std::max(excess_um, 1e3 * chip.length_mm - max_chip_ratio(job) * depth_um);
    }
  return excess_um;
}

/// Returns programs with one changed line, and descriptions of the changes.
std::vector<std::pair<std::string, std::string>> faults_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::vector<std::pair<std::string, std::string>> faults;
  const auto add = [&](std::size_t i, const std::string& what, const std::vector<std::string>& instead) {
    std::string changed;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k != i) {
        changed += lines[k] + "\n";
        continue;
      }
      for (const std::string& line : instead) changed += line + "\n";
    }
    faults.emplace_back(fmt::format("line {} {}: {}", i + 1, what, lines[i]), changed);
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (line.empty() || line[0] == '(' || line[0] == '%') continue;
    add(i, "lost", {});
    add(i, "doubled", {line, line});
    for (const char axis : {'X', 'Y', 'Z'}) {
      const std::size_t word = line.find(std::string(" ") + axis);
      if (word == std::string::npos) continue;
      std::size_t read = 0;
      const double value = std::stod(line.substr(word + 2), &read);
      for (const double by_mm : {-0.06, 0.06, -0.006, 0.006})
        add(i, fmt::format("{}{:+}", axis, by_mm),
            {line.substr(0, word + 2) + fmt::format("{:.6f}", value + by_mm) + line.substr(word + 2 + read)});
    }
  }
  return faults;
}

/// Returns a job with one element and few thick cuts, so that its program is short.
Job short_job(Strategy strategy) {
  Job job = strategy == Strategy::dmc ? cube_job(false, 0.3) : square_job(1);
  if (strategy == Strategy::dmc) {
    job.array = {};
    job.array.arrangement = geometry::Arrangement::single;
  }
  job.strategy = strategy;
  job.process.roughing_depth_um = strategy == Strategy::dmc ? 25.0 : 60.0;
  job.process.finishing_depth_um = 10.0;
  job.process.finishing_cuts = 2;
  return job;
}

Verification verified(const Job& job, const Machine& m, const std::string& text) {
  return verify_programs(job, m, {parse_nc(text, "p.ngc", NcDialect::rs274ngc)}, {}, {});
}

bool has_kind(const Verification& v, const std::string& kind) {
  return std::any_of(v.findings.begin(), v.findings.end(), [&](const Finding& f) { return f.kind == kind; });
}

class ChipFaults : public ::testing::TestWithParam<Strategy> {};

TEST_P(ChipFaults, EveryLineWhoseLossOrChangeThickensAChipIsFound) {
  const Job job = short_job(GetParam());
  const Machine m = machine(job.strategy == Strategy::dmc ? "ideal-dmc" : "ideal");
  const std::string text = nc_text(make_plan(job, m).programs.front(), "rs274ngc");
  EXPECT_LE(true_excess_um(job, m, text), 0.01);
  int thick = 0;
  int told = 0;
  for (const auto& [what, changed] : faults_of(text)) {
    try {
      const double excess_um = true_excess_um(job, m, changed);
      const Verification v = verified(job, m, changed);
      if (excess_um < 0.05) continue;
      ++thick;
      EXPECT_FALSE(v.passes()) << what << " takes " << excess_um << " um too much\n" << listed(v);
      told += has_kind(v, "chip_too_thick") ? 1 : 0;
    } catch (const InputError&) {
      continue;  // the changed program is refused
    }
  }
  EXPECT_GT(thick, 50);
  EXPECT_GT(told, thick * 4 / 5) << "the others cut beside the element";
}

/// Returns the text of a program in which the calls of one subroutine are removed, or displaced along Z by `by_nm`.
std::string changed_stage(const Plan& plan, std::size_t subroutine, std::optional<Nanometres> by_nm) {
  Program program = plan.programs.front();
  const auto is_of_it = [&](const Item& item) {
    const auto* const visit = std::get_if<CycleCall>(&item);
    return visit != nullptr && visit->subroutine == subroutine;
  };
  if (!by_nm) std::erase_if(program.items, is_of_it);
  for (Item& item : program.items)
    if (is_of_it(item)) std::get<CycleCall>(item).start.z() += by_nm.value_or(0);
  return nc_text(program, "rs274ngc");
}

TEST_P(ChipFaults, AStageThatIsGoneOrStandsTooHighIsFound) {
  for (const int cuts : {1, 2, 3})
    for (const char* name : {"ideal", "paper"}) {
      Job job = short_job(GetParam());
      job.process.finishing_cuts = cuts;
      job.process.finishing_depth_um = 5.0;
      const Machine m = machine(job.strategy == Strategy::dmc ? "ideal-dmc" : name);
      const Plan plan = make_plan(job, m);
      for (std::size_t k = 0; k < plan.subroutines.size(); ++k)
        for (const std::optional<Nanometres> by_nm : {std::optional<Nanometres>(), {Nanometres{60'000}}}) {
          const std::string text = changed_stage(plan, k, by_nm);
          if (!verified(job, m, text).passes()) continue;
          // The first layer can be so thin that a program without this layer is still correct. In this case, the next
          // layer removes the material of the first layer.
          const std::string& title = plan.subroutines[k].title;
          EXPECT_TRUE(title.starts_with("layer-1") && true_excess_um(job, m, text) < 0.0) << title << " of " << cuts;
        }
    }
}

/// On a substrate, a tilted edge can leave a strip as wide as the depth of cut, so that chips can be thicker by this
/// amount. The thickness of chips therefore does not show a missing finishing cut. The verifier must count the
/// finishing cuts.
TEST(FinishingFaults, AFinishingCutThatIsMissingIsFoundWhereTheEdgeIsTilted) {
  Job job = square_job(2, geometry::Arrangement::aligned);
  job.substrate = {geometry::PlaneSubstrate{0.35, 90.0}, geometry::ElementAxes::normal};
  const Machine m = machine("ideal");
  const Plan plan = make_plan(job, m);
  int counted = 0;
  for (std::size_t k = 0; k < plan.subroutines.size(); ++k) {
    const Verification v = verified(job, m, changed_stage(plan, k, std::nullopt));
    EXPECT_FALSE(v.passes()) << plan.subroutines[k].title;
    counted += has_kind(v, "finishing_missing") ? 1 : 0;
  }
  EXPECT_EQ(counted, 2) << "the first finishing cut of either facet";
}

INSTANTIATE_TEST_SUITE_P(Strategies, ChipFaults,
                         ::testing::Values(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step,
                                           Strategy::dmc));

}  // namespace
}  // namespace retrace::fabrication::test::chip_faults_test
