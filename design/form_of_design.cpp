#include "design/form_of_design.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/length_units.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "geometry/elements/element_cells.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/light/aperture_kernel.h"
#include "surface_models/form.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::design {
namespace {

using geometry::Polygon, geometry::Vec2, surface_models::FacetForm, surface_models::HeightMap;

constexpr double kMaxMissingFraction = 0.05;
/// Maximum slope of a form. The model neglects terms of second order in the slope. Its relative error is therefore at
/// most this value.
constexpr double kSteepest = 0.03;
/// Minimum fraction of a facet's extent that a map must cover. The polynomial is extrapolated to the remainder.
constexpr double kMinCoveredFraction = 0.9;
constexpr std::size_t kMinPoints = 8;
/// Number of quadrature points along each side of a triangle of a facet. The quadrature is exact for squares of
/// polynomials of degree 8.
constexpr std::size_t kPoints = 10;

/// Facet of the design's element without angle errors and without cant, in the frame of the facet.
struct NominalFacet {
  Polygon corners;
  double radius_mm = 0.0;

  explicit NominalFacet(geometry::Element element) {
    std::visit(
        Overloaded{[](geometry::RtpElement&) {}, [](geometry::RuledCells&) {}, [](auto& cube) { cube.cant = {}; }},
        element);
    const geometry::CellFacet facet = geometry::element_cell(element).facets.front();
    const geometry::Vec3 down(facet.plane.slope.x(), facet.plane.slope.y(), -1.0);
    const raytrace::FacetFrame frame(down.normalized(), -facet.plane.height_mm / down.norm(), *facet.centroid_mm);
    for (const Vec2& p : facet.outline) {
      corners.push_back(frame.local({p.x(), p.y(), facet.plane.at(p)}));
      radius_mm = std::max(radius_mm, corners.back().norm());
    }
  }

  /// Calls visit(point, weight) for the quadrature points of the facet. The weight is the point's fraction of the area.
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    static const raytrace::GaussRule rule = raytrace::gauss_legendre(kPoints);
    const double whole = 2.0 * std::abs(geometry::area(corners));
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const Vec2 p = corners[k - 1] - corners[0], q = corners[k] - corners[0];
      const double twice = std::abs(p.x() * q.y() - p.y() * q.x());
      for (std::size_t i = 0; i < kPoints; ++i)
        for (std::size_t j = 0; j < kPoints; ++j) {
          const double u = rule.nodes[i], v = rule.nodes[j];
          visit(Vec2(corners[0] + u * ((1.0 - v) * p + v * q)),
                2.0 * twice / whole * u * rule.weights[i] * rule.weights[j]);
        }
    }
  }

  /// Returns the plane that fits a form best: height at the origin, and slopes along x and y.
  Eigen::Vector3d best_plane(const FacetForm& form) const {
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for_each_point([&](const Vec2& p, double share) {
      const Eigen::Vector3d powers(1.0, p.x() / radius_mm, p.y() / radius_mm);
      moments += share * powers * powers.transpose();
      right += share * form.height_mm(p) * powers;
    });
    const Eigen::Vector3d plane = moments.ldlt().solve(right);
    return {plane[0], plane[1] / radius_mm, plane[2] / radius_mm};
  }

  FacetForm less_plane(FacetForm form) const {
    const Eigen::Vector3d plane = best_plane(form);
    form.add(0, 0, -plane[0]);
    form.add(1, 0, -plane[1]);
    form.add(0, 1, -plane[2]);
    return form;
  }

  double steepest(const FacetForm& form) const {
    double steepest = 0.0;
    const auto look = [&](const Vec2& p) { steepest = std::max(steepest, form.slope(p).norm()); };
    for (const Vec2& corner : corners) look(corner);
    for_each_point([&](const Vec2& p, double) { look(p); });
    return steepest;
  }
};

FacetForm sink(const NominalFacet& facet, double sink_um) {
  const double depth_mm = kMmPerUm * sink_um;
  const double curvature = depth_mm / (facet.radius_mm * facet.radius_mm);
  FacetForm form;
  form.add(2, 0, curvature);
  form.add(0, 2, curvature);
  return facet.less_plane(form);
}

/// Reads a height map and fits the form polynomial to it.
/// \throw InputError if the map cannot be read or does not cover the facet
FacetForm measured(const NominalFacet& facet, const FormMap& map, const std::string& source, Warnings& warnings) {
  const HeightMap level = facet_aligned_map(map.file, map.horizontal_axis, source, warnings);
  const auto fail = [&](const std::string& complaint) { throw InputError({map.file.string(), 0, ""}, complaint); };
  if (level.columns < kMinPoints || level.rows < kMinPoints)
    fail(fmt::format("must have at least {0} x {0} points, got {1} x {2}", kMinPoints, level.columns, level.rows));
  const Vec2 half_mm =
      0.5 * kMmPerUm *
      Vec2(level.x_pixel_um * static_cast<double>(level.columns), level.y_pixel_um * static_cast<double>(level.rows));
  Vec2 reach_mm = Vec2::Zero();
  for (const Vec2& corner : facet.corners) reach_mm = reach_mm.cwiseMax(corner.cwiseAbs());
  if ((half_mm.array() < kMinCoveredFraction * reach_mm.array()).any())
    fail(fmt::format(
        "must cover the facet around its centroid, {} um horizontally and {} um down the facet, got {} um by {} um",
        fixed(2.0 * reach_mm.x() / kMmPerUm, 1), fixed(2.0 * reach_mm.y() / kMmPerUm, 1),
        fixed(2.0 * half_mm.x() / kMmPerUm, 1), fixed(2.0 * half_mm.y() / kMmPerUm, 1)));
  return facet.less_plane(surface_models::fitted_form(level, map.degree));
}

}  // namespace

HeightMap facet_aligned_map(const std::filesystem::path& file, HeightMapAxis level_axis, const std::string& source,
                            Warnings& warnings) {
  using namespace surface_models;
  HeightMapOptions options;
  options.suggests_options = false;
  HeightMapFile read = read_height_map(file, options);
  const std::size_t points = read.map.heights_nm.size();
  const std::size_t missing = points - measured_points(read.map);
  if (static_cast<double>(missing) > kMaxMissingFraction * static_cast<double>(points))
    read.warnings.push_back(
        {"missing_points",
         fmt::format("{:.1f} % of the points have no measured height; the mean height is used for these points",
                     100.0 * static_cast<double>(missing) / static_cast<double>(points))});
  for (const Warning& warning : read.warnings)
    warnings.push_back({warning.id, fmt::format("{}: {}: {}", source, file.string(), warning.text)});
  return level_axis == HeightMapAxis::x ? std::move(read.map) : rotated_by_90_degrees(read.map);
}

FacetForm form_of_design(const Design& design, Warnings& warnings) {
  const FormOfFacets& given = design.surface.form;
  if (given.is_plane()) return {};
  const NominalFacet facet(design.part().element);
  FacetForm form;
  if (given.sink_um != 0.0) form.add(sink(facet, given.sink_um));
  for (const FormTerm& term : given.terms)
    form.add(term.x_power, term.y_power,
             kMmPerUm * term.height_um / std::pow(facet.radius_mm, static_cast<double>(term.x_power + term.y_power)));
  if (given.map) try {
      form.add(measured(facet, *given.map, design.source_name(), warnings));
    } catch (const InputError& error) {
      throw InputError(design.where("form.map"), error.what());  // adds the position of the key that names the file
    }
  const double steepest = facet.steepest(form);
  if (!(steepest <= kSteepest))
    throw InputError(design.where_form(), fmt::format("the slope of the form over a facet must be <= {}, got {}",
                                                      kSteepest, fixed_apart(steepest, kSteepest, 4)));
  return form;
}

FormReport report_form(const Design& design, const FacetForm& form) {
  const NominalFacet facet(design.part().element);
  const Eigen::Vector3d plane = facet.best_plane(form);
  FormReport report;
  report.radius_mm = facet.radius_mm;
  report.lowest_um = report.highest_um = form.height_mm(facet.corners.front()) / kMmPerUm;
  const auto look = [&](const Vec2& p) {
    const double um = form.height_mm(p) / kMmPerUm;
    report.lowest_um = std::min(report.lowest_um, um);
    report.highest_um = std::max(report.highest_um, um);
  };
  look(Vec2::Zero());
  for (const Vec2& corner : facet.corners) look(corner);
  double square_um2 = 0.0;
  facet.for_each_point([&](const Vec2& p, double share) {
    look(p);
    const double left_um = (form.height_mm(p) - plane[0] - plane.tail<2>().dot(p)) / kMmPerUm;
    square_um2 += share * left_um * left_um;
  });
  report.rms_um = std::sqrt(square_um2);
  report.tilt_mrad = 1e3 * plane.tail<2>().norm();
  report.steepest_mrad = 1e3 * facet.steepest(form);
  return report;
}

}  // namespace retrace::design
