#include "raytrace/observers/lattice_field.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "raytrace/observers/aperture_field.h"
#include "raytrace/observers/distant_directions.h"

namespace retrace::raytrace {
namespace {

using field_lanes::Block, field_lanes::ComplexBlock, field_lanes::kBlock;
using geometry::Vec2, std::numbers::pi;
using Complex = std::complex<double>;

// Coherent fractions below this value are neglected, so that the intensities of cells are added exactly.
constexpr double kMinCoherentFraction = 1e-12;
// Number of wavelengths of a band for each radius of the discs by which the band moves an order.
constexpr double kLinesPerReach = 6.0;
constexpr double kMaxLines = 512.0;
// Maximum number of evaluations of the field for one reading and one wavelength. If orders are so close that more
// evaluations are needed, fewer wavelengths of the band are used, because the discs then average over many orders.
constexpr double kMaxNodes = 100'000.0;
// Number of wavelengths of a band at which each order of a map is repeated.
constexpr double kLinesOfMap = 32.0;
// Number of points of a Gauss rule: a minimum, and an increase per period of the finest fringe.
constexpr double kMinPoints = 4.0;
constexpr double kPointsPerFringe = 2.0;
constexpr std::size_t kMaxPoints = 64;

/// Point of a quadrature rule over the displacements of the source.
struct SourceNode {
  Vec2 shift_rad;
  double weight = 0.0;
};

std::size_t points_across(double length_rad, double detail_rad) {
  // The displacement d of the source changes the direction relative to the pattern of a cell by 2 d.
  return static_cast<std::size_t>(std::clamp(std::ceil(kMinPoints + kPointsPerFringe * 2.0 * length_rad / detail_rad),
                                             kMinPoints, static_cast<double>(kMaxPoints)));
}

/// Gauss rules that are computed one time.
class GaussRules {
 public:
  /// \pre count <= kMaxPoints
  const GaussRule& operator()(std::size_t count) {
    GaussRule& rule = rules_[count];
    if (rule.nodes.empty()) rule = gauss_legendre(count);
    return rule;
  }

 private:
  std::array<GaussRule, kMaxPoints + 1> rules_;
};

/// Adds the points of a disc. The weights add up to its area times `factor`.
void add_disc(const Vec2& centre, double radius, double detail_rad, double factor, GaussRules& rules,
              std::vector<SourceNode>& nodes) {
  const GaussRule& radial = rules(points_across(radius, detail_rad));
  const auto round = static_cast<std::size_t>(std::ceil(pi * static_cast<double>(points_across(radius, detail_rad))));
  for (std::size_t k = 0; k < radial.nodes.size(); ++k) {
    const double r = radius * radial.nodes[k];
    const double weight = factor * radial.weights[k] * radius * r * 2.0 * pi / static_cast<double>(round);
    for (std::size_t j = 0; j < round; ++j) {
      const double angle =
          2.0 * pi * (static_cast<double>(j) + std::numbers::phi * static_cast<double>(k)) / static_cast<double>(round);
      nodes.push_back({centre + r * Vec2(std::cos(angle), std::sin(angle)), weight});
    }
  }
}

/// Adds the points of a circular segment: the points of a disc whose coordinate along `axis`, relative to the centre,
/// is at least `from`. The weights add up to its area times `factor`.
void add_segment(const Vec2& centre, const Vec2& axis, double radius, double from, double detail_rad, double factor,
                 GaussRules& rules, std::vector<SourceNode>& nodes) {
  // The coordinate along the axis is radius cos(angle). This substitution makes the integrand smooth at the border.
  const double most = std::acos(std::clamp(from / radius, -1.0, 1.0));
  const Vec2 across(-axis.y(), axis.x());
  const GaussRule& along = rules(points_across(radius - from, detail_rad));
  const double widest = most > 0.5 * pi ? radius : radius * std::sin(most);
  const GaussRule& over = rules(points_across(2.0 * widest, detail_rad));
  for (std::size_t k = 0; k < along.nodes.size(); ++k) {
    const double angle = most * along.nodes[k];
    const double half = radius * std::sin(angle);
    const double weight = factor * along.weights[k] * most * half * 2.0 * half;
    for (std::size_t j = 0; j < over.nodes.size(); ++j)
      nodes.push_back({centre + radius * std::cos(angle) * axis + half * (2.0 * over.nodes[j] - 1.0) * across,
                       weight * over.weights[j]});
  }
}

/// Returns points for the mean over the discs of source and receiver of light in one order. If the source is displaced
/// by d, the order is located at `order_rad` - d, relative to the centre of the receiver. The points are the
/// displacements for which the order is inside the receiver. The sum of the weights is ApertureKernel::per_sr().
/// \param detail_rad width of the finest details of the cell's pattern
std::vector<SourceNode> source_nodes(const ApertureKernel& kernel, const Vec2& order_rad, double detail_rad,
                                     GaussRules& rules) {
  const double source = kernel.source_radius_rad(), receiver = kernel.receiver_radius_rad();
  const double distance = order_rad.norm();
  std::vector<SourceNode> nodes;
  if (distance >= source + receiver) return nodes;
  const double point = 1e-9 * (source + receiver);
  if (source <= point) return {{Vec2::Zero(), 1.0 / (pi * receiver * receiver)}};
  if (receiver <= point) return {{order_rad, 1.0 / (pi * source * source)}};
  const double factor = 1.0 / (pi * source * source * pi * receiver * receiver);
  if (distance <= std::abs(source - receiver)) {
    add_disc(source < receiver ? Vec2(Vec2::Zero()) : order_rad, std::min(source, receiver), detail_rad, factor, rules,
             nodes);
    return nodes;
  }
  const Vec2 axis = order_rad / distance;
  // Position along the axis of the chord that both circles have in common.
  const double chord = (distance * distance + source * source - receiver * receiver) / (2.0 * distance);
  add_segment(Vec2::Zero(), axis, source, chord, detail_rad, factor, rules, nodes);
  add_segment(order_rad, -axis, receiver, distance - chord, detail_rad, factor, rules, nodes);
  return nodes;
}

double wave_number_of(double wavelength_mm) {
  return 2.0 * pi / wavelength_mm;
}

}  // namespace

LatticeField::LatticeField(const Setting& setting, const std::vector<CoherentGroup>& groups)
    : setting_(setting),
      coherency_{setting.coherency(0, 0).real(), setting.coherency(1, 1).real(), setting.coherency(0, 1).real(),
                 setting.coherency(0, 1).imag()} {
  std::vector<const CoherentGroup*> sorted;
  for (const CoherentGroup& group : groups)
    if (!group.replicate) sorted.push_back(&group);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const CoherentGroup* a, const CoherentGroup* b) { return a->path_mm < b->path_mm; });
  std::size_t waves = 0;
  double last_path_mm = 0.0;
  for (const CoherentGroup* group : sorted) {
    if (classes_.empty() || group->path_mm - last_path_mm > setting.coherence_length_mm) {
      classes_.emplace_back();
      waves = 0;
    }
    last_path_mm = group->path_mm;
    extent_mm_ = std::max(extent_mm_, group->extent_mm);
    Cell cell{{}, group->positions_mm, group->path_mm};
    for (const FieldPolygon& polygon : group->polygons) {
      cell.waves.push_back({field_lanes::Outline(polygon.transform), polygon.cosines, polygon.entry_mm,
                            polygon.entry_slope, polygon.path_mm});
      classes_.back().uses.push_back(use_of(waves++, polygon));
    }
    classes_.back().cells.push_back(std::move(cell));
  }
}

/// A cell at the height h has the phase k n (cos_in + cos_out) h, with the cosines inside the part. A displacement of a
/// cell by u has the phase k (q + s) . u.
double LatticeField::coherent_fraction(const Vec2& cosines) const {
  const CellInterference& cells = setting_.cells;
  const auto cosine_inside = [&](const Vec2& outside) {
    return std::sqrt(std::max(0.0, 1.0 - outside.squaredNorm() / (cells.index * cells.index)));
  };
  const double per_depth = cells.index * (cosine_inside(setting_.source_cosines) + cosine_inside(cosines));
  const double per_spacing2 = (cosines + setting_.source_cosines).squaredNorm();
  const double variance =
      std::pow(wave_number_of(setting_.wavelength_mm), 2.0) *
      (std::pow(per_depth * cells.depth_spread_mm, 2.0) + per_spacing2 * std::pow(cells.spacing_spread_mm, 2.0));
  const double fraction = std::exp(-variance);
  return fraction < kMinCoherentFraction ? 0.0 : fraction;
}

/// Returns the power of the field of one period, without the factor 1 / wavelength^2.
std::vector<double> LatticeField::period_power(std::span<const Node> nodes, double wavelength_mm,
                                               const Cancellation* cancel) const {
  const double wave_number = wave_number_of(wavelength_mm);
  const double difference = wave_number - wave_number_of(setting_.wavelength_mm);
  std::vector<double> power(nodes.size(), 0.0);
  std::vector<ComplexBlock> transforms;
  for (std::size_t first = 0; first < nodes.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, nodes.size() - first);
    const auto node = [&](std::size_t k) -> const Node& { return nodes[first + std::min(k, count - 1)]; };
    Block sums{};
    for (const Class& light : classes_) {
      transforms.resize(light.uses.size());
      std::size_t number = 0;
      for (const Cell& cell : light.cells) {
        if (is_cancelled(cancel)) return power;
        std::array<Complex, kBlock> positions;
        for (std::size_t k = 0; k < kBlock; ++k) {
          positions[k] = 0.0;
          for (const Vec2& position : cell.positions_mm)
            positions[k] += std::polar(1.0, wave_number * cell.path_mm - node(k).g_per_mm.dot(position));
        }
        for (const Wave& wave : cell.waves) {
          Block kx, ky;
          const Vec2 fixed = setting_.source_cosines + wave.cosines;
          for (std::size_t k = 0; k < kBlock; ++k) {
            const Vec2& shift = node(k).source_shift;
            const Vec2 kappa = node(k).g_per_mm - wave_number * (fixed + shift - wave.entry_slope.transpose() * shift);
            kx[k] = kappa.x();
            ky[k] = kappa.y();
          }
          ComplexBlock& transform = transforms[number++];
          field_lanes::transform(wave.outline, kx, ky, transform);
          for (std::size_t k = 0; k < kBlock; ++k) {
            const double phase = difference * wave.path_mm - wave_number * node(k).source_shift.dot(wave.entry_mm);
            const Complex value = Complex(transform.re[k], transform.im[k]) * positions[k] * std::polar(1.0, phase);
            transform.re[k] = value.real();
            transform.im[k] = value.imag();
          }
        }
      }
      field_lanes::add_power(light.uses, transforms, coherency_, 1.0, sums);
    }
    std::copy_n(sums.begin(), count, power.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return power;
}

/// Returns wavelengths of the band, each of which represents the same flux.
/// \param shift_of_band distance by which the band moves an order
/// \param step distance between neighbouring wavelengths
std::vector<double> LatticeField::wavelengths_mm(double shift_of_band, double step) const {
  const std::vector<double>& band = setting_.cells.band_nm;
  if (band.size() < 2) return {setting_.wavelength_mm};
  const double count = std::clamp(std::ceil(shift_of_band / step), 1.0, kMaxLines);
  if (count == 1.0) return {setting_.wavelength_mm};
  std::vector<double> wavelengths;
  for (double k = 0.5; k < count; k += 1.0) {
    const double at = k / count * static_cast<double>(band.size() - 1);
    const auto index = std::min(static_cast<std::size_t>(at), band.size() - 2);
    wavelengths.push_back(1e-6 * std::lerp(band[index], band[index + 1], at - static_cast<double>(index)));
  }
  return wavelengths;
}

template <class Visit>
void LatticeField::for_each_order(const Vec2& centre, double radius, double wavelength_mm, const Visit& visit) const {
  const Vec2 middle = setting_.periods_mm.transpose() * (centre + setting_.source_cosines) / wavelength_mm;
  const Vec2 reach = radius / wavelength_mm * setting_.periods_mm.colwise().norm().transpose();
  const Eigen::Matrix2d reciprocal = 2.0 * pi * setting_.periods_mm.transpose().inverse();
  const Vec2 from = (middle - reach).array().ceil(), to = (middle + reach).array().floor();
  for (double m = from.x(); m <= to.x(); m += 1.0)
    for (double n = from.y(); n <= to.y(); n += 1.0) {
      const Vec2 g_per_mm = reciprocal * Vec2(m, n);
      visit(Vec2(g_per_mm / wave_number_of(wavelength_mm) - setting_.source_cosines), g_per_mm);
    }
}

double LatticeField::per_sr(const Vec2& cosines, const Eigen::Matrix2d& cosines_per_rad, const ApertureKernel& kernel,
                            const Cancellation* cancel) const {
  const double fraction = coherent_fraction(cosines);
  if (fraction == 0.0 || classes_.empty()) return 0.0;
  const double area_mm2 = std::abs(setting_.periods_mm.determinant());
  const Eigen::Matrix2d rad_per_cosine = cosines_per_rad.inverse();
  const double detail_rad = setting_.wavelength_mm / extent_mm_;
  // The reach in the plane of direction cosines is at most that in the plane of angles.
  const double reach_rad = kernel.reach_rad();
  GaussRules rules;
  const auto count_of = [&](double wavelength_mm) {
    double nodes = 0.0;
    for_each_order(cosines, reach_rad, wavelength_mm, [&](const Vec2& order, const Vec2&) {
      nodes += static_cast<double>(source_nodes(kernel, rad_per_cosine * (order - cosines), detail_rad, rules).size());
    });
    return nodes;
  };
  double shift_rad = 0.0;
  if (const std::vector<double>& band = setting_.cells.band_nm; band.size() >= 2)
    shift_rad = (rad_per_cosine * (cosines + setting_.source_cosines)).norm() * 1e-6 * (band.back() - band.front()) /
                setting_.wavelength_mm;
  const double most = std::max(1.0, kMaxNodes / std::max(1.0, count_of(setting_.wavelength_mm)));
  const std::vector<double> wavelengths =
      wavelengths_mm(shift_rad, std::max(reach_rad / kLinesPerReach, shift_rad / most));
  double sum = 0.0;
  for (const double wavelength_mm : wavelengths) {
    std::vector<Node> nodes;
    std::vector<double> weights;
    for_each_order(cosines, reach_rad, wavelength_mm, [&](const Vec2& order, const Vec2& g_per_mm) {
      if (order.squaredNorm() >= 1.0) return;
      for (const SourceNode& node : source_nodes(kernel, rad_per_cosine * (order - cosines), detail_rad, rules)) {
        nodes.push_back({g_per_mm, cosines_per_rad * node.shift_rad});
        weights.push_back(node.weight);
      }
    });
    const std::vector<double> power = period_power(nodes, wavelength_mm, cancel);
    for (std::size_t k = 0; k < power.size(); ++k) sum += weights[k] * power[k];
  }
  return fraction * sum / (area_mm2 * static_cast<double>(wavelengths.size()));
}

std::vector<LatticeField::Order> LatticeField::orders_near(const Vec2& centre, double radius, Light light,
                                                           const Cancellation* cancel) const {
  const double area_mm2 = std::abs(setting_.periods_mm.determinant());
  const std::vector<double> wavelengths =
      light == Light::band ? wavelengths_mm(kLinesOfMap, 1.0) : std::vector{setting_.wavelength_mm};
  std::vector<Order> orders;
  for (const double wavelength_mm : wavelengths) {
    std::vector<Node> nodes;
    const std::size_t first = orders.size();
    for_each_order(centre, radius, wavelength_mm, [&](const Vec2& order, const Vec2& g_per_mm) {
      const double fraction = coherent_fraction(order);
      if (fraction == 0.0 || (order - centre).norm() > radius) return;
      nodes.push_back({g_per_mm, Vec2::Zero()});
      orders.push_back({order, fraction / (area_mm2 * static_cast<double>(wavelengths.size()))});
    });
    const std::vector<double> power = period_power(nodes, wavelength_mm, cancel);
    for (std::size_t k = 0; k < power.size(); ++k) orders[first + k].power *= power[k];
  }
  return orders;
}

/// The sum over orders is replaced by an integral over directions of the field of one period.
double LatticeField::power_beyond(const Vec2& centre, double radius, const Cancellation* cancel) const {
  const double wave_number = wave_number_of(setting_.wavelength_mm);
  const DistantDirections distant(centre, radius);
  std::vector<Node> nodes;
  for (const Vec2& at : distant.cosines) nodes.push_back({wave_number * (at + setting_.source_cosines), Vec2::Zero()});
  const std::vector<double> power = period_power(nodes, setting_.wavelength_mm, cancel);
  double sum = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k)
    sum += distant.areas[k] * coherent_fraction(distant.cosines[k]) * power[k];
  return distant.factor * sum / (setting_.wavelength_mm * setting_.wavelength_mm);
}

double LatticeField::radius_of_orders(double count) const {
  return setting_.wavelength_mm * std::sqrt(count / (pi * std::abs(setting_.periods_mm.determinant())));
}

}  // namespace retrace::raytrace
