#include "geometry/io/step_reader.h"

#include <fmt/format.h>

#include <bit>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/io/reader_program.h"
#include "geometry/io/step_message.h"

namespace retrace::geometry {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMessageBytes = 400;

/// Runs the program that reads STEP files, and returns its result.
std::string result_of_program(const StepChoice& choice, std::string_view kind) {
  std::vector<std::string> words = {std::string(kind), choice.file.string(), choice.face, shortest(choice.sew_mm)};
  for (const double angle : choice.rotation_deg) words.push_back(shortest(angle));
  if (choice.origin_mm)
    for (const double c : *choice.origin_mm) words.push_back(shortest(c));
  return result_of_step_program(std::move(words));
}

PatchTree tree_of(StepMessageReader& reader) {
  PatchTree tree;
  tree.patches = reader.list<HeightPatch>([&] {
    HeightPatch patch;
    patch.centre_mm = reader.point();
    patch.half_mm = reader.point();
    for (double& coefficient : patch.coefficients) coefficient = reader.number();
    return patch;
  });
  const std::size_t nodes = reader.count();
  for (std::size_t k = 0; k < nodes; ++k) {
    PatchNode node;
    node.axis = static_cast<int>(reader.index(3)) - 1;
    node.split_mm = reader.number();
    if (node.axis >= 0) {
      node.first = reader.index(nodes);
      node.second = reader.index(nodes);
      if (node.first <= k || node.second <= k) StepMessageReader::fail();
    } else if (const std::uint32_t patch = reader.index(tree.patches.size() + 1); patch > 0) {
      node.first = patch - 1;
    }
    tree.nodes.push_back(node);
  }
  if (tree.nodes.empty()) StepMessageReader::fail();
  return tree;
}

StepSurface surface_of_result(StepMessageReader& reader) {
  std::vector<PatchTree> faces = reader.list<PatchTree>([&] { return tree_of(reader); });
  const auto loop = [&] { return reader.list<Vec2>([&] { return reader.point(); }); };
  std::vector<FaceBorder> borders = reader.list<FaceBorder>([&] { return reader.list<std::vector<Vec2>>(loop); });
  if (faces.empty() || faces.size() != borders.size()) StepMessageReader::fail();
  StepSurface surface{.patches = PatchSurface(std::move(faces), std::move(borders))};
  surface.origin_mm = reader.position();
  surface.size_mm = reader.point();
  surface.unit = reader.text();
  surface.deviation_mm = reader.number();
  surface.deviation_arcsec = reader.number();
  surface.gap_mm = reader.number();
  surface.breaks = reader.list<TangentBreak>([&] {
    const double angle_deg = reader.number();
    return TangentBreak{angle_deg, reader.position()};
  });
  return surface;
}

std::vector<OutlineLoop> loops_of_result(StepMessageReader& reader) {
  return reader.list<OutlineLoop>([&] {
    return reader.list<OutlineSide>([&] {
      const Vec2 from = reader.point();
      const Vec2 to = reader.point();
      return OutlineSide{from, to, reader.number()};
    });
  });
}

/// Runs the program, and converts its result.
/// \param convert function that reads the part of the result behind its first number
template <class Convert>
auto converted(const StepChoice& choice, std::string_view kind, StepResult expected, const Convert& convert) {
  try {
    const std::string result = result_of_program(choice, kind);
    StepMessageReader reader(result);
    const double first = reader.number();
    if (first == static_cast<double>(StepResult::refused)) throw InputError(printable(reader.text(), kMaxMessageBytes));
    if (first != static_cast<double>(expected)) StepMessageReader::fail();
    return convert(reader);
  } catch (const InputError& error) {
    throw InputError({choice.file.string(), 0, ""}, error.what());
  } catch (const std::runtime_error& error) {
    throw InputError({choice.file.string(), 0, ""},
                     fmt::format("cannot be read by OpenCASCADE: {}", printable(error.what(), kMaxMessageBytes)));
  }
}

/// Text that differs for files and selections with different results.
std::string identity_of(const StepChoice& choice) {
  std::error_code ignored;
  const auto time = fs::last_write_time(choice.file, ignored).time_since_epoch().count();
  std::string identity = fmt::format("{}\n{}\n{}\n{}\n{}", fs::absolute(choice.file, ignored).string(), time,
                                     fs::file_size(choice.file, ignored), choice.face, shortest(choice.sew_mm));
  for (const double angle : choice.rotation_deg) identity += "\n" + shortest(angle);
  if (choice.origin_mm)
    for (const double c : *choice.origin_mm) identity += "\n" + shortest(c);
  return identity;
}

/// Results that were read before. A sweep reads each design many times, but its STEP files only one time.
template <class Result>
class KeptResults {
 public:
  template <class Read>
  std::shared_ptr<const Result> get(const StepChoice& choice, const Read& read) {
    require_short_file(choice.file, kMaxStepBytes);
    std::error_code ignored;
    if (!fs::exists(choice.file, ignored)) static_cast<void>(read_file(choice.file, kMaxStepBytes));
    const std::string identity = identity_of(choice);
    const std::lock_guard lock(mutex_);
    if (const auto known = results_.find(identity); known != results_.end()) return known->second;
    if (results_.size() >= kMaxResults) results_.clear();
    return results_.emplace(identity, std::make_shared<const Result>(read())).first->second;
  }

 private:
  static constexpr std::size_t kMaxResults = 64;

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const Result>> results_;
};

}  // namespace

std::shared_ptr<const StepSurface> read_step_surface(const StepChoice& choice) {
  static KeptResults<StepSurface> kept;
  return kept.get(choice, [&] { return converted(choice, kStepSurfaceWord, StepResult::surface, surface_of_result); });
}

std::vector<OutlineLoop> read_step_outline(const StepChoice& choice) {
  static KeptResults<std::vector<OutlineLoop>> kept;
  return *kept.get(choice, [&] { return converted(choice, kStepOutlineWord, StepResult::outline, loops_of_result); });
}

}  // namespace retrace::geometry
