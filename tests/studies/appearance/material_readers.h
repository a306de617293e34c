#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

// Readers of what `retrace export` writes of a material, by the formats' own rules: nothing here is retrace's.

namespace retrace::test {

using Triple = std::array<double, 3>;

/// A direction of an angle from +z and an azimuth, in degrees.
Triple direction(double angle_deg, double azimuth_deg);

/// A BSDF file of Radiance whose tree has rank 4, looked up as Radiance does.
class RadianceFile {
 public:
  explicit RadianceFile(const std::string& xml);
  /// The side of a leaf, over the unit square.
  double least_leaf() const { return least_leaf_; }
  /// BRDF of light from one direction in another.
  double brdf(const Triple& in, const Triple& out) const;
  /// Share of light from a direction that goes anywhere: leaves times their projected solid angle.
  double reflected(const Triple& in) const;

 private:
  struct Node {
    std::vector<Node> branches;
    double value = 0.0;
  };
  static Node parse(const std::string& text, std::size_t& at);
  double sum_below(const Node& node, std::array<double, 2> light, double size) const;

  Node root_;
  double least_leaf_ = 1.0;
};

/// The function of a shader with lobes, by its constants.
class GlslFile {
 public:
  explicit GlslFile(const std::string& text);
  /// Luminous BRDF.
  double brdf(Triple to_source, Triple to_observer) const;

 private:
  std::map<std::string, std::vector<double>> constants_;
  double scale_ = 0.0;
  std::array<bool, 2> mirrors_{};
};

}  // namespace retrace::test
