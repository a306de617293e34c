#include "studies/appearance/io/glsl_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "core/version.h"

namespace retrace::studies {
namespace {

/// Formats a number so that GLSL reads it as a float.
std::string number(double value) {
  std::string text = fmt::format("{:.7g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// Returns the GLSL text `const TYPE NAME[n] = TYPE[n](...);` with one line for each lobe.
/// \param each number of values for each lobe
/// \param of function that returns the values of a lobe as text
template <class Of>
std::string constant(const ReflectionLobes& lobes, const std::string& type, const std::string& name, std::size_t each,
                     Of of) {
  std::vector<std::string> values;
  for (const Lobe& lobe : lobes.lobes) values.push_back("  " + of(lobe));
  const std::size_t count = each * lobes.lobes.size();
  return fmt::format("const {0} {1}[{2}] = {0}[{2}](\n{3});\n", type, name, count, fmt::join(values, ",\n"));
}

std::string mirroring(const ReflectionLobes& lobes) {
  std::string text;
  for (const std::size_t axis : {0U, 1U})
    if (lobes.mirrors[axis])
      text += fmt::format("  if (light.{0} < 0.0) {{ light.{0} = -light.{0}; deviation.{0} = -deviation.{0}; }}\n",
                          axis == 0 ? 'x' : 'y');
  return text;
}

}  // namespace

std::string glsl_text(const ReflectionLobes& lobes, const std::vector<std::string>& remarks) {
  std::string text = fmt::format("// Written by retrace {}.\n", kVersion);
  for (const std::string& remark : remarks) text += "// " + remark + '\n';
  text +=
      "// retrace_brdf returns the BRDF in 1/sr (linear sRGB) around the direction of the returned light. This "
      "direction is\n"
      "// back to the source or, for prisms, reversed along only one axis. Both arguments are unit vectors that point "
      "away\n"
      "// from the surface, in the part frame (+z: normal of the part, +y: datum mark). R_A is the BRDF times both "
      "cosines.\n"
      "// The BRDF contains neither the mirror image nor light in other directions.\n";
  text += fmt::format("const int RETRACE_LOBES = {};\n", lobes.lobes.size());
  text +=
      "// Centres of the lobes, inverses of their covariance matrices (xx, xy, yy), and their densities at the "
      "centres.\n";
  text += constant(lobes, "vec2", "RETRACE_CENTRE", 1, [](const Lobe& lobe) {
    return fmt::format("vec2({}, {})", number(lobe.centre.x()), number(lobe.centre.y()));
  });
  text += constant(lobes, "vec3", "RETRACE_SHAPE", 1, [](const Lobe& lobe) {
    return fmt::format("vec3({}, {}, {})", number(lobe.spread.y() / lobe.determinant()),
                       number(-lobe.covariance / lobe.determinant()), number(lobe.spread.x() / lobe.determinant()));
  });
  text += constant(lobes, "float", "RETRACE_DENSITY", 1, [](const Lobe& lobe) { return number(lobe.peak()); });
  text += constant(lobes, "vec3", "RETRACE_COLOUR", 1, [](const Lobe& lobe) {
    return fmt::format("vec3({}, {}, {})", number(lobe.colour[0]), number(lobe.colour[1]), number(lobe.colour[2]));
  });
  text += "// Power of each lobe as a polynomial in x and y of the light: terms of degree 0, of degree 1, ...\n";
  text += constant(lobes, "float", "RETRACE_POWER", Lobe::kTerms, [](const Lobe& lobe) {
    std::vector<std::string> terms;
    for (const double term : lobe.power) terms.push_back(number(term));
    return fmt::format("{}", fmt::join(terms, ", "));
  });
  text += fmt::format(R"(
vec3 retrace_brdf(vec3 to_source, vec3 to_observer) {{
  vec2 light = to_source.xy;
  vec2 deviation = to_observer.xy - vec2({}, {}) * light;
{}  light /= {};
  if (dot(light, light) > 1.0) return vec3(0.0);  // nothing was fitted there
  float x = light.x, y = light.y;
  float terms[{}] = float[{}](1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y,
    x * x * x * x, x * x * x * y, x * x * y * y, x * y * y * y, y * y * y * y);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < RETRACE_LOBES; ++k) {{
    float power = 0.0;
    for (int term = 0; term < {}; ++term) power += RETRACE_POWER[{} * k + term] * terms[term];
    vec2 d = deviation - RETRACE_CENTRE[k];
    vec3 shape = RETRACE_SHAPE[k];
    float square = shape.x * d.x * d.x + 2.0 * shape.y * d.x * d.y + shape.z * d.y * d.y;
    sum += power * RETRACE_DENSITY[k] * exp(-0.5 * square) * RETRACE_COLOUR[k];
  }}
  return max(sum, vec3(0.0));
}}
)",
                      number(lobes.back.x()), number(lobes.back.y()), mirroring(lobes), number(lobes.scale),
                      Lobe::kTerms, Lobe::kTerms, Lobe::kTerms, Lobe::kTerms);
  return text;
}

}  // namespace retrace::studies
