#include "surface_models/scatter/height_map_scatter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/fft.h"
#include "surface_models/form.h"
#include "surface_models/height_parameters.h"
#include "surface_models/scatter/phase.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {
namespace {

using std::numbers::pi;
constexpr std::size_t kMinPoints = 8;
constexpr int kMaxTries = 10000;

/// Cell in the plane of spatial frequencies.
struct Cell {
  Vec2 frequency_per_um = Vec2::Zero();  ///< centre of the cell
  double fraction = 0.0;                 ///< fraction of the variance of heights
};

/// Cumulative values over all cells up to this cell. Cells are sorted by distance from the frequency 0.
struct Cumulative {
  double fraction = 0.0;
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();  ///< sum of fraction * f f^T, where f is the frequency of a cell
};

double hann(std::size_t k, std::size_t count) {
  const double sine = std::sin(pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
  return sine * sine;
}

/// Returns the signed index of a row or column of a discrete spectrum.
std::ptrdiff_t signed_index(std::size_t k, std::size_t count) {
  const auto index = static_cast<std::ptrdiff_t>(k);
  return 2 * k > count ? index - static_cast<std::ptrdiff_t>(count) : index;
}

/// Returns the fractions of the variance over the plane of frequencies, row by row in the order of the discrete
/// transform. The value at the frequency 0 is 0. A Hann window is applied, because opposite borders of a map do not
/// match.
std::vector<double> variance_fractions(const HeightMap& levelled) {
  const std::size_t rows = levelled.rows, columns = levelled.columns;
  RealFft fft(rows, columns);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      if (const double height = levelled.at(c, r); std::isfinite(height))
        fft.field(c, r) = height * hann(c, columns) * hann(r, rows);
  fft.forward();
  std::vector<double> shares(rows * columns);
  double sum = 0.0;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      // Columns beyond the centre are not stored. They are the complex conjugates of the columns at the opposite
      // frequency.
      const bool held = c < fft.spectrum_columns();
      const std::size_t row = held ? r : (rows - r) % rows;
      const std::size_t column = held ? c : columns - c;
      const double power = r + c == 0 ? 0.0 : std::norm(fft.spectrum()[row * fft.spectrum_columns() + column]);
      shares[r * columns + c] = power;
      sum += power;
    }
  if (sum > 0.0)
    for (double& share : shares) share /= sum;
  return shares;
}

/// Returns the gradients of a levelled map (its mean plane was subtracted), computed from central differences over a
/// distance of at least `base_um`.
std::vector<Vec2> gradients(const HeightMap& map, double base_um) {
  const auto half_base = [&](double pixel_um, std::size_t points) {
    const auto steps = static_cast<std::size_t>(std::ceil(0.5 * base_um / pixel_um));
    return std::clamp<std::size_t>(steps, 1, (points - 1) / 2);
  };
  const std::size_t dx = half_base(map.x_pixel_um, map.columns);
  const std::size_t dy = half_base(map.y_pixel_um, map.rows);
  const double x_base_nm = 2e3 * static_cast<double>(dx) * map.x_pixel_um;
  const double y_base_nm = 2e3 * static_cast<double>(dy) * map.y_pixel_um;
  std::vector<Vec2> found;
  for (std::size_t r = dy; r + dy < map.rows; ++r)
    for (std::size_t c = dx; c + dx < map.columns; ++c) {
      const Vec2 gradient((map.at(c + dx, r) - map.at(c - dx, r)) / x_base_nm,
                          (map.at(c, r + dy) - map.at(c, r - dy)) / y_base_nm);
      if (gradient.allFinite()) found.push_back(gradient);
    }
  return found;
}

}  // namespace

struct HeightMapScatter::Texture {
  std::size_t rows = 0, columns = 0;
  Vec2 pixel_um, frequency_step_per_um;
  double sq_nm = 0.0, kurtosis = 3.0;
  std::vector<double> fractions;       ///< variance_fractions()
  std::vector<Cell> cells;             ///< sorted by distance from frequency 0
  std::vector<Cumulative> cumulative;  ///< cumulative values of the cells
  std::vector<Vec2> facet_gradients;   ///< in the axes of the map
  double steepest = 0.0;
  double rms_slope = 0.0;

  void set_spectrum(const HeightMap& levelled) {
    rows = levelled.rows;
    columns = levelled.columns;
    pixel_um = {levelled.x_pixel_um, levelled.y_pixel_um};
    frequency_step_per_um = {1.0 / (static_cast<double>(columns) * pixel_um.x()),
                             1.0 / (static_cast<double>(rows) * pixel_um.y())};
    fractions = variance_fractions(levelled);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const Vec2 steps(static_cast<double>(signed_index(c, columns)), static_cast<double>(signed_index(r, rows)));
        const double share = fractions[r * columns + c];
        if (share > 0.0) cells.push_back({steps.cwiseProduct(frequency_step_per_um), share});
      }
    std::stable_sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
      return a.frequency_per_um.squaredNorm() < b.frequency_per_um.squaredNorm();
    });
    Cumulative sum;
    for (const Cell& cell : cells) {
      sum.fraction += cell.fraction;
      sum.moment += cell.fraction * cell.frequency_per_um * cell.frequency_per_um.transpose();
      cumulative.push_back(sum);
    }
  }

  void set_facets(std::vector<Vec2> found) {
    facet_gradients = std::move(found);
    double squares = 0.0;
    for (const Vec2& gradient : facet_gradients) {
      squares += gradient.squaredNorm();
      steepest = std::max(steepest, gradient.norm());
    }
    if (!facet_gradients.empty()) rms_slope = std::sqrt(squares / static_cast<double>(facet_gradients.size()));
  }

  double fraction_at(const Vec2& frequency_per_um) const {
    const double column = std::round(frequency_per_um.x() / frequency_step_per_um.x());
    const double row = std::round(frequency_per_um.y() / frequency_step_per_um.y());
    const auto in_range = [](double k, std::size_t n) {
      return 2.0 * k > -static_cast<double>(n) && 2.0 * k <= static_cast<double>(n);
    };
    if (!in_range(column, columns) || !in_range(row, rows)) return 0.0;
    const auto wrapped = [](double k, std::size_t n) {
      return static_cast<std::size_t>(k < 0.0 ? k + static_cast<double>(n) : k);
    };
    return fractions[wrapped(row, rows) * columns + wrapped(column, columns)];
  }
};

/// Spatial frequencies below n / w, which scatter in an event, and their shifts of direction cosines.
struct HeightMapScatter::Band {
  const Texture& texture;
  double wave_um;         ///< wavelength in the medium to which the lobe goes
  double y_sign;          ///< sign of the map's y axis along the event's y axis
  std::size_t cells = 0;  ///< number of cells that scatter
  Cumulative sum;         ///< sums over the cells that scatter
  double sq_nm = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< covariance of the shift by one diffraction

  Band(const Texture& from, const ScatterEvent& event, Lobe lobe)
      : texture(from),
        wave_um(1e-3 * event.wavelength_nm / event.index_of(lobe)),
        y_sign(event.inside_material ? -1.0 : 1.0) {
    const auto end = std::partition_point(texture.cells.begin(), texture.cells.end(), [&](const Cell& cell) {
      return cell.frequency_per_um.squaredNorm() * wave_um * wave_um < 1.0;
    });
    cells = static_cast<std::size_t>(end - texture.cells.begin());
    if (cells == 0) return;
    sum = texture.cumulative[cells - 1];
    sq_nm = texture.sq_nm * std::sqrt(sum.fraction);
    covariance = sum.moment / sum.fraction * (wave_um * wave_um);
    covariance(0, 1) = covariance(1, 0) *= y_sign;
  }

  Vec2 sample_shift(int order, RandomStream& random) const {
    if (order > 1) {
      return std::sqrt(static_cast<double>(order)) * (root_of_covariance() * normal_pair(random));
    }
    const double drawn = random.next() * sum.fraction;
    const auto last = texture.cumulative.begin() + static_cast<std::ptrdiff_t>(cells) - 1;
    const auto found = std::upper_bound(texture.cumulative.begin(), last, drawn,
                                        [](double value, const Cumulative& upto) { return value < upto.fraction; });
    const Cell& cell = texture.cells[static_cast<std::size_t>(found - texture.cumulative.begin())];
    const Vec2 within(random.next() - 0.5, random.next() - 0.5);
    const Vec2 frequency = cell.frequency_per_um + within.cwiseProduct(texture.frequency_step_per_um);
    return wave_um * Vec2(frequency.x(), y_sign * frequency.y());
  }

  double shift_density(int order, const Vec2& shift) const {
    if (order > 1) {
      const Eigen::Matrix2d wide = order * covariance;
      const double determinant = wide.determinant();
      if (determinant <= 0.0) return 0.0;
      return std::exp(-0.5 * shift.dot(wide.inverse() * shift)) / (2.0 * pi * std::sqrt(determinant));
    }
    const Vec2 frequency(shift.x() / wave_um, y_sign * shift.y() / wave_um);
    const Vec2 step = texture.frequency_step_per_um;
    const Vec2 centre(std::round(frequency.x() / step.x()) * step.x(), std::round(frequency.y() / step.y()) * step.y());
    if (centre.squaredNorm() * wave_um * wave_um >= 1.0) return 0.0;
    return texture.fraction_at(frequency) / (sum.fraction * step.x() * step.y() * wave_um * wave_um);
  }

  /// Returns a matrix whose product with its transpose is the covariance.
  Eigen::Matrix2d root_of_covariance() const {
    const double xx = std::sqrt(covariance(0, 0));
    const double yx = xx > 0.0 ? covariance(1, 0) / xx : 0.0;
    const double yy = std::sqrt(std::max(0.0, covariance(1, 1) - yx * yx));
    Eigen::Matrix2d root;
    root << xx, 0.0, yx, yy;
    return root;
  }
};

HeightMapScatter::HeightMapScatter(const HeightMap& map, double wavelength_nm) {
  if (map.rows < kMinPoints || map.columns < kMinPoints)
    throw InputError("a height map that scatters light must have at least 8 x 8 points, got " +
                     std::to_string(map.columns) + " x " + std::to_string(map.rows));
  if (map.rows * map.columns > kMaxScatterPoints)
    throw InputError("a height map that scatters light may have at most " + std::to_string(kMaxScatterPoints) +
                     " points, got " + std::to_string(map.columns) + " x " + std::to_string(map.rows) +
                     ": use a section of the map");
  if (measured_points(map) == 0) throw InputError("the height map contains no measured point");
  const HeightMap levelled = without_form(map, 1);
  const HeightParameters heights = height_parameters(levelled.heights_nm);
  auto texture = std::make_shared<Texture>();
  texture->sq_nm = heights.sq_nm;
  texture->kurtosis = heights.sku;
  texture->set_spectrum(levelled);
  texture->set_facets(gradients(levelled, 1e-3 * wavelength_nm));
  require_slope_in_range(texture->rms_slope, "height map (check the unit of its heights)");
  texture_ = std::move(texture);
}

double HeightMapScatter::sq_nm() const {
  return texture_->sq_nm;
}

Facet HeightMapScatter::sample_facet(const ScatterEvent& event, RandomStream& random) const {
  const double phase = reflection_phase_rad(texture_->sq_nm, event.index_from, event.cos_in(), event.wavelength_nm);
  const std::vector<Vec2>& gradients = texture_->facet_gradients;
  if (phase * phase < kSlopePhase2 || gradients.empty()) return {};
  const Vec3 light = -event.direction_in;
  const double bound = light.z() + light.head<2>().norm() * texture_->steepest;
  const auto count = static_cast<double>(gradients.size());
  for (int tries = 0; tries < kMaxTries; ++tries) {
    const Vec2& gradient = gradients[static_cast<std::size_t>(random.next() * count)];
    // For light from inside the material, the event's frame is rotated by 180 degrees about x, which reverses height
    // and y. Only the slope along x then changes its sign.
    const Vec3 normal =
        event.inside_material ? Vec3(gradient.x(), -gradient.y(), 1.0) : Vec3(-gradient.x(), -gradient.y(), 1.0);
    if (random.next() * bound < light.dot(normal)) return {normal.normalized(), true};
  }
  return {};
}

double HeightMapScatter::specular_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  if (facet.is_tilted) return 1.0;
  const auto phase_lobe = PhaseLobe::make(event, lobe, Band(*texture_, event, lobe).sq_nm);
  return phase_lobe ? phase_lobe->specular_fraction() : 0.0;
}

double HeightMapScatter::scattered_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  if (facet.is_tilted) return 0.0;
  const auto phase_lobe = PhaseLobe::make(event, lobe, Band(*texture_, event, lobe).sq_nm);
  return phase_lobe ? phase_lobe->scattered_fraction() : 0.0;
}

std::optional<Vec2> HeightMapScatter::draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                                     RandomStream& random) const {
  if (facet.is_tilted) return std::nullopt;
  const Band band(*texture_, event, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, band.sq_nm);
  if (!phase_lobe) return std::nullopt;
  return phase_lobe->sample_scattered(
      random, [&](int order, RandomStream& numbers) { return band.sample_shift(order, numbers); });
}

double HeightMapScatter::unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                          const Vec2& beta) const {
  const Band band(*texture_, event, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, band.sq_nm);
  if (facet.is_tilted || !phase_lobe || band.cells == 0 || beta.squaredNorm() >= 1.0) return 0.0;
  const Vec2 shift = beta - phase_lobe->specular_beta();
  return phase_lobe->density(beta, 1, [&](int order) { return band.shift_density(order, shift); });
}

double HeightMapScatter::scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                           const Vec2& beta) const {
  const Band band(*texture_, event, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, band.sq_nm);
  if (facet.is_tilted || !phase_lobe || band.cells == 0) return 0.0;
  // The direction of light that is diffracted once follows the cells of the spectrum. The density of all other light is
  // smooth.
  const Vec2 specular = phase_lobe->specular_beta();
  double sum = 0.0;
  for (std::size_t k = 0; k < band.cells; ++k) {
    const Cell& cell = texture_->cells[k];
    const Vec2 at = specular + band.wave_um * Vec2(cell.frequency_per_um.x(), band.y_sign * cell.frequency_per_um.y());
    if (at.squaredNorm() < 1.0)
      sum += cell.fraction / band.sum.fraction * PhaseLobe::order_probability(1, phase_lobe->variance(at));
  }
  sum += integrate_over_disc(specular, std::sqrt(band.covariance.trace()), [&](const Vec2& at) {
    return phase_lobe->density(at, 2, [&](int order) { return band.shift_density(order, at - specular); });
  });
  return sum > 0.0 ? phase_lobe->scattered_fraction() * unscaled_density(event, facet, lobe, beta) / sum : 0.0;
}

Warnings HeightMapScatter::warnings(double index, double wavelength_nm) const {
  Warnings found;
  const Texture& t = *texture_;
  const double wave_um = 1e-3 * wavelength_nm / index;
  if (const double pixel = t.pixel_um.maxCoeff(); pixel > 0.5 * wave_um)
    found.push_back({"coarse_height_map",
                     "points of the height map are " + shortest(pixel) +
                         " um apart, more than half a wavelength in the material: finer roughness is missing"});
  if (t.rms_slope > kMaxSlopeWithoutWarning)
    found.push_back({"steep_height_map",
                     "the rms slope of the height map is " + fixed_apart(t.rms_slope, kMaxSlopeWithoutWarning, 3) +
                         ", which is above " + shortest(kMaxSlopeWithoutWarning) +
                         ": masking, and light that is reflected several times on the surface, are not modelled"});
  if (t.sq_nm > 0.0 && std::abs(t.kurtosis - 3.0) > 1.0)
    found.push_back({"heights_not_gaussian",
                     "kurtosis of the heights is " + fixed(t.kurtosis, 2) +
                         " instead of 3, the value of Gaussian heights: small specular fractions are inaccurate"});
  return found;
}

}  // namespace retrace::surface_models
