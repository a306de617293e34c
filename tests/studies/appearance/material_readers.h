#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

// Readers of the material files that `retrace export` writes. They follow the specifications of the formats and share
// no code with the writers.

namespace retrace::test {

using Triple = std::array<double, 3>;

/// Returns the unit vector with an angle from +z and an azimuth, both in degrees.
Triple direction(double angle_deg, double azimuth_deg);

/// A BSDF file of Radiance with a tensor tree of rank 4. Values are looked up in the same way as in Radiance.
class RadianceFile {
 public:
  explicit RadianceFile(const std::string& xml);
  /// Side of the smallest leaf of the tree, as a fraction of the side of the unit square.
  double min_leaf() const { return min_leaf_; }
  /// Returns the BRDF for light from the direction `in` that is reflected into the direction `out`.
  double brdf(const Triple& in, const Triple& out) const;
  /// Returns the fraction of light from the direction `in` that is reflected into all directions. It is the sum of the
  /// values of the leaves, each multiplied by the projected solid angle of the leaf.
  double reflected(const Triple& in) const;

 private:
  struct Node {
    std::vector<Node> branches;
    double value = 0.0;
  };
  static Node parse(const std::string& text, std::size_t& at);
  double sum_below(const Node& node, std::array<double, 2> light, double size) const;

  Node root_;
  double min_leaf_ = 1.0;
};

/// Evaluates the function of an exported GLSL shader, a sum of lobes, from the constants in its text.
class GlslFile {
 public:
  explicit GlslFile(const std::string& text);
  /// Returns the luminance of the BRDF, computed from linear red, green and blue with the weights of sRGB.
  double brdf(Triple to_source, Triple to_observer) const;

 private:
  std::map<std::string, std::vector<double>> constants_;
  double scale_ = 0.0;
  std::array<bool, 2> mirrors_{};
};

}  // namespace retrace::test
