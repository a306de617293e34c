#include "tests/studies/appearance/material_readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

namespace retrace::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Maps the unit disc to the unit square by the concentric map of Shirley and Chiu.
std::array<double, 2> square_of(double x, double y) {
  const double radius = std::hypot(x, y);
  double angle = std::atan2(y, x);
  if (angle < -kPi / 4.0) angle += 2.0 * kPi;
  double a = 0.0;
  double b = 0.0;
  if (angle < kPi / 4.0) {
    a = radius;
    b = angle * a / (kPi / 4.0);
  } else if (angle < 3.0 * kPi / 4.0) {
    b = radius;
    a = -(angle - kPi / 2.0) * b / (kPi / 4.0);
  } else if (angle < 5.0 * kPi / 4.0) {
    a = -radius;
    b = (angle - kPi) * a / (kPi / 4.0);
  } else {
    b = -radius;
    a = -(angle - 1.5 * kPi) * b / (kPi / 4.0);
  }
  return {(a + 1.0) / 2.0, (b + 1.0) / 2.0};
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  EXPECT_NE(begin, std::string::npos) << from;
  const std::size_t first = begin + from.size();
  return text.substr(first, text.find(to, first) - first);
}

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  static const std::regex number("-?[0-9]+\\.?[0-9]*(e[-+]?[0-9]+)?");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), number); it != std::sregex_iterator(); ++it)
    numbers.push_back(std::stod(it->str()));
  return numbers;
}

}  // namespace

Triple direction(double angle_deg, double azimuth_deg) {
  const double angle = angle_deg * kPi / 180.0;
  const double azimuth = azimuth_deg * kPi / 180.0;
  return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
}

RadianceFile::RadianceFile(const std::string& xml) {
  EXPECT_EQ(between(xml, "<IncidentDataStructure>", "<"), "TensorTree4");
  EXPECT_EQ(between(xml, "<AngleBasis>", "<"), "LBNL/Shirley-Chiu");
  // "Back" is the direction in the format of WINDOW (LBNL). In Radiance, it is the side to which the surface normal
  // points.
  EXPECT_EQ(between(xml, "<WavelengthDataDirection>", "<"), "Reflection Back");
  const std::string data = between(xml, "<ScatteringData>", "<");
  std::size_t at = 0;
  root_ = parse(data, at);
  EXPECT_EQ(data.find_first_not_of(" \n", at), std::string::npos) << "text behind the tree";
  const std::function<int(const Node&)> depth = [&](const Node& node) {
    int most = -1;
    for (const Node& branch : node.branches) most = std::max(most, depth(branch));
    return most + 1;
  };
  min_leaf_ = std::ldexp(1.0, -depth(root_));
}

/// Parses a node, which is either `{value}`, or `{` followed by 16 branches and `}`.
RadianceFile::Node RadianceFile::parse(const std::string& text, std::size_t& at) {
  const auto next = [&] {
    at = text.find_first_not_of(" \n", at);
    return at == std::string::npos ? '\0' : text[at];
  };
  Node node;
  EXPECT_EQ(next(), '{');
  ++at;
  if (next() == '{') {
    while (next() == '{') node.branches.push_back(parse(text, at));
    EXPECT_EQ(node.branches.size(), 16U);
  } else {
    std::size_t length = 0;
    node.value = std::stod(text.substr(at, 32), &length);
    at += length;
  }
  EXPECT_EQ(next(), '}');
  ++at;
  return node;
}

double RadianceFile::brdf(const Triple& in, const Triple& out) const {
  const std::array<double, 2> light = square_of(-in[0], -in[1]);
  const std::array<double, 2> view = square_of(out[0], out[1]);
  std::array<double, 4> place = {light[0], light[1], view[0], view[1]};
  const Node* node = &root_;
  while (!node->branches.empty()) {
    std::size_t branch = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      place[k] *= 2.0;
      if (place[k] < 1.0) continue;
      place[k] -= 1.0;
      branch |= std::size_t{1} << k;
    }
    node = &node->branches[branch];
  }
  return node->value;
}

double RadianceFile::reflected(const Triple& in) const {
  return kPi * sum_below(root_, square_of(-in[0], -in[1]), 1.0);
}

double RadianceFile::sum_below(const Node& node, std::array<double, 2> light, double size) const {
  if (node.branches.empty()) return node.value * size * size;
  std::size_t half = 0;
  for (std::size_t k = 0; k < light.size(); ++k) {
    light[k] *= 2.0;
    if (light[k] < 1.0) continue;
    light[k] -= 1.0;
    half |= std::size_t{1} << k;
  }
  double sum = 0.0;
  for (std::size_t view = 0; view < 4; ++view) sum += sum_below(node.branches[half | (view << 2)], light, size / 2.0);
  return sum;
}

GlslFile::GlslFile(const std::string& text) {
  for (const std::string name : {"CENTRE", "SHAPE", "DENSITY", "COLOUR", "POWER"}) {
    std::string values = between(text, "RETRACE_" + name + "[", ";");
    values = values.substr(values.find('(') + 1);
    constants_[name] = numbers_of(std::regex_replace(values, std::regex("vec[23]"), ""));
  }
  scale_ = std::stod(between(text, "light /= ", ";"));
  mirrors_ = {text.find("light.x < 0.0") != std::string::npos, text.find("light.y < 0.0") != std::string::npos};
}

double GlslFile::brdf(Triple to_source, Triple to_observer) const {
  for (const std::size_t axis : {0U, 1U})
    if (mirrors_[axis] && to_source[axis] < 0.0)
      for (Triple* direction : {&to_source, &to_observer}) (*direction)[axis] = -(*direction)[axis];
  const double x = to_source[0] / scale_;
  const double y = to_source[1] / scale_;
  if (x * x + y * y > 1.0) return 0.0;
  Triple sum{};
  for (std::size_t k = 0; k < constants_.at("DENSITY").size(); ++k) {
    double power = 0.0;
    std::size_t term = 15 * k;
    for (int degree = 0; degree <= 4; ++degree)
      for (int j = 0; j <= degree; ++j)
        power += constants_.at("POWER")[term++] * std::pow(x, degree - j) * std::pow(y, j);
    const double u = to_observer[0] - to_source[0] - constants_.at("CENTRE")[2 * k];
    const double v = to_observer[1] - to_source[1] - constants_.at("CENTRE")[2 * k + 1];
    const double* shape = &constants_.at("SHAPE")[3 * k];
    const double here = power * constants_.at("DENSITY")[k] *
                        std::exp(-0.5 * (shape[0] * u * u + 2.0 * shape[1] * u * v + shape[2] * v * v));
    for (std::size_t band = 0; band < 3; ++band) sum[band] += here * constants_.at("COLOUR")[3 * k + band];
  }
  return 0.2126 * std::max(sum[0], 0.0) + 0.7152 * std::max(sum[1], 0.0) + 0.0722 * std::max(sum[2], 0.0);
}

}  // namespace retrace::test
