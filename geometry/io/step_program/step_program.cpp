// Program that reads one STEP file for retrace (step_reader.cpp starts it):
//   retrace_step_reader surface|outline FILE FACE SEW_MM ROTATION_X ROTATION_Y ROTATION_Z [ORIGIN_X ORIGIN_Y ORIGIN_Z]
//   retrace_step_reader solid FILE CHORD_MM
// It limits its own memory and time, and writes its result to standard output (step_message.h). OpenCASCADE is used in
// this program only, because damaged files can make it crash or allocate memory without limit.

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Standard_Failure.hxx>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "geometry/io/reader_program.h"
#include "geometry/io/step_message.h"
#include "geometry/io/step_program/step_fit.h"
#include "geometry/io/step_program/step_shapes.h"
#include "geometry/io/step_program/step_triangles.h"

namespace retrace::geometry {
namespace {

constexpr int kFirstAngle = 5;
constexpr int kFirstCoordinate = 8;
constexpr int kLast = 11;
constexpr int kWordsOfSolid = 4;

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RETRACE_STEP_IS_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(RETRACE_STEP_IS_SANITIZED)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

/// Limits the memory and the processor time of this process. Sanitizers reserve more addresses than the limit.
void limit_resources() {
  const rlimit memory{kMaxStepMemoryBytes, kMaxStepMemoryBytes};
  if (!kIsSanitized) ::setrlimit(RLIMIT_AS, &memory);
  const auto seconds = static_cast<rlim_t>(kMaxStepSeconds);
  const rlimit time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

StepChoice choice_of(const std::vector<std::string>& words) {
  const auto number = [&](int k) { return std::strtod(words[static_cast<std::size_t>(k)].c_str(), nullptr); };
  StepChoice choice;
  choice.file = words[2];
  choice.face = words[3];
  choice.sew_mm = number(4);
  for (int axis = 0; axis < 3; ++axis) choice.rotation_deg[static_cast<std::size_t>(axis)] = number(kFirstAngle + axis);
  if (words.size() == kLast)
    choice.origin_mm = {number(kFirstCoordinate), number(kFirstCoordinate + 1), number(kFirstCoordinate + 2)};
  return choice;
}

void put_tree(StepMessageWriter& writer, const PatchTree& tree) {
  writer.put_list(tree.patches, [&](const HeightPatch& patch) {
    writer.put(patch.centre_mm);
    writer.put(patch.half_mm);
    for (const double coefficient : patch.coefficients) writer.put(coefficient);
  });
  writer.put_list(tree.nodes, [&](const PatchNode& node) {
    writer.put(static_cast<double>(node.axis + 1));
    writer.put(node.split_mm);
    if (node.axis >= 0) {
      writer.put(static_cast<double>(node.first));
      writer.put(static_cast<double>(node.second));
    } else {
      writer.put(node.first == PatchNode::kNone ? 0.0 : static_cast<double>(node.first) + 1.0);
    }
  });
}

void put_surface(StepMessageWriter& writer, const StepChoice& choice) {
  const ChosenFaces chosen = choose_faces(choice);
  const FittedFaces fitted = fit_faces(chosen, choice);
  const std::vector<TangentBreak> breaks = tangent_breaks(chosen, choice);
  writer.put(static_cast<double>(StepResult::surface));
  writer.put_list(fitted.patches.faces, [&](const PatchTree& tree) { put_tree(writer, tree); });
  writer.put_list(fitted.patches.borders, [&](const FaceBorder& border) {
    writer.put_list(
        border, [&](const std::vector<Vec2>& loop) { writer.put_list(loop, [&](const Vec2& p) { writer.put(p); }); });
  });
  writer.put(Vec3(rotation_of(choice).transpose() * fitted.origin_mm));
  writer.put(fitted.size_mm);
  writer.put(std::string_view(chosen.unit));
  writer.put(fitted.deviation_mm);
  writer.put(fitted.deviation_arcsec);
  writer.put(chosen.gap_mm);
  writer.put_list(breaks, [&](const TangentBreak& tangent_break) {
    writer.put(tangent_break.angle_deg);
    writer.put(tangent_break.at_mm);
  });
}

void put_outline(StepMessageWriter& writer, const StepChoice& choice) {
  const std::vector<OutlineLoop> loops = loops_around(choose_faces(choice), choice.sew_mm);
  writer.put(static_cast<double>(StepResult::outline));
  writer.put_list(loops, [&](const OutlineLoop& loop) {
    writer.put_list(loop, [&](const OutlineSide& side) {
      writer.put(side.from_mm);
      writer.put(side.to_mm);
      writer.put(side.bulge);
    });
  });
}

void put_solid(StepMessageWriter& writer, const std::vector<std::string>& words) {
  const SolidMesh solid = solids_of_file(words[2], std::strtod(words[3].c_str(), nullptr));
  writer.put(static_cast<double>(StepResult::solid));
  writer.put(static_cast<double>(solid.solids));
  writer.put_list(solid.mesh.vertices, [&](const Vec3& p) { writer.put(p); });
  writer.put_list(solid.planes, [&](const std::optional<FacetPlane>& plane) {
    writer.put(plane ? 1.0 : 0.0);
    writer.put(plane ? plane->normal : Vec3(Vec3::Zero()));
    writer.put(plane ? plane->offset_mm : 0.0);
  });
  writer.put_list(solid.mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t corner : triangle) writer.put(static_cast<double>(corner));
  });
  for (const std::uint32_t face : solid.face_of) writer.put(static_cast<double>(face));
}

void put_result(StepMessageWriter& writer, const std::vector<std::string>& words) {
  if (words[1] == kStepSolidWord) return put_solid(writer, words);
  (words[1] == kStepOutlineWord ? put_outline : put_surface)(writer, choice_of(words));
}

std::string refusal(std::string_view text) {
  StepMessageWriter writer;
  writer.put(static_cast<double>(StepResult::refused));
  writer.put(text);
  return writer.text();
}

std::string result_of(const std::vector<std::string>& words) {
  try {
    StepMessageWriter writer;
    put_result(writer, words);
    return writer.text();
  } catch (const std::bad_alloc&) {
    return refusal("must be readable within 1 GiB of memory: export fewer faces from the CAD program");
  } catch (const Standard_Failure& failure) {
    const std::string type = failure.DynamicType()->Name();
    if (type == "Standard_OutOfMemory")
      return refusal("must be readable within 1 GiB of memory: export fewer faces from the CAD program");
    return refusal("cannot be read by OpenCASCADE: " + type + " " + failure.GetMessageString());
  } catch (const std::exception& error) {
    return refusal(error.what());
  }
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace
}  // namespace retrace::geometry

int main(int count, char** arguments) {
  using namespace retrace::geometry;
  const std::vector<std::string> words(arguments, arguments + count);
  if (words.size() != kLast && words.size() != kFirstCoordinate && words.size() != kWordsOfSolid) return 2;
  limit_resources();
  // OpenCASCADE prints messages to standard output, which must contain only the result.
  const int output = ::dup(STDOUT_FILENO);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (output < 0 || nowhere < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0) return 2;
  const bool is_written = write_all(output, result_of(words));
  // OpenCASCADE frees its objects slowly.
  ::_exit(is_written ? 0 : 2);
}
