#include "geometry/io/step_program/step_fit.h"

#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Dense>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

#include "geometry/io/step_program/step_refusal.h"
#include "geometry/io/step_reader.h"

namespace retrace::geometry {
namespace {

using jets::Gradient;

/// Minimum cosine of the angle between z and the normal of a face: the cosine of 89 degrees.
constexpr double kMinUpwards = 0.017452406437283512;
constexpr double kArcsecPerRad = 206264.80624709636;
constexpr int kNodes = kPatchDegree + 1;
constexpr std::size_t kMaxPatches = 20000;

std::string place_of(const Vec2& p) {
  std::ostringstream text;
  text.precision(6);
  text << "x = " << p.x() << ", y = " << p.y() << " mm";
  return text.str();
}

[[noreturn]] void refuse_fold(const Vec2& p) {
  refuse_step("must have a face with one height above each point, but it folds or is vertical near " + place_of(p) +
              " of the rotated file: choose another face, or set rotation_deg so that +z points to the light");
}

/// Height of a face and its slope.
struct FaceHeight {
  double z_mm = 0.0;
  Vec2 slope = Vec2::Zero();
};

/// Point of a face that is known by its parameters.
struct FacePoint {
  double u = 0.0;
  double v = 0.0;
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();   ///< unit normal that points upwards
  bool is_along_surface = true;  ///< true if the normal is that of the surface, false if it is the opposite
};

Vec3 vector_of(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

/// Face as a function z(x, y). The function continues beyond the border of the face.
class FaceHeights {
 public:
  /// \param border border of the face in plan
  FaceHeights(const TopoDS_Face& face, const FaceBorder& border)
      : surface_(BRep_Tool::Surface(face)),
        adaptor_(surface_),
        border_(face, Precision::PConfusion()),
        border_in_plan_({PatchTree{}}, {border}) {
    BRepTools::UVBounds(face, low_.x(), high_.x(), low_.y(), high_.y());
    if (!low_.allFinite() || !high_.allFinite() || low_.cwiseAbs().maxCoeff() > 1e9 ||
        high_.cwiseAbs().maxCoeff() > 1e9)
      refuse_step("must have faces of finite size");
    surface_->Bounds(natural_low_.x(), natural_high_.x(), natural_low_.y(), natural_high_.y());
    find_range();
    is_periodic_ = {surface_->IsUPeriodic() == Standard_True, surface_->IsVPeriodic() == Standard_True};
    sample();
    sort_samples();
  }

  /// Returns the point of the face at fractions of its ranges of parameters. Returns nothing outside of the face.
  std::optional<FacePoint> point_at(double u_fraction, double v_fraction) {
    const double u = low_.x() + u_fraction * (high_.x() - low_.x());
    const double v = low_.y() + v_fraction * (high_.y() - low_.y());
    if (has_range_ && border_.Perform(gp_Pnt2d(u, v)) == TopAbs_OUT) return std::nullopt;
    const std::optional<FacePoint> point = point_of(u, v);
    if (has_range_ || !point) return point;
    // The whole surface may have other points above the face.
    const bool is_of_face = border_in_plan_.covers(point->position.head<2>(), 0.0) &&
                            (samples_.empty() || point->is_along_surface == samples_.front().is_along_surface);
    return is_of_face ? point : std::nullopt;
  }

  std::size_t sample_count() const { return samples_.size(); }
  /// Returns the median height of the samples.
  double middle_z_mm() const {
    std::vector<double> heights;
    for (const FacePoint& sample : samples_) heights.push_back(sample.position.z());
    std::nth_element(heights.begin(), heights.begin() + std::ssize(heights) / 2, heights.end());
    return heights[heights.size() / 2];
  }

  /// Returns the height above a point, or nothing if the face and its continuation have none.
  std::optional<FaceHeight> at(const Vec2& point) const {
    switch (adaptor_.GetType()) {
      case GeomAbs_Plane: return at_plane(point);
      case GeomAbs_Sphere: return at_sphere(point);
      case GeomAbs_Cylinder: return at_cylinder(point);
      default: return by_search(point);
    }
  }

 private:
  std::optional<FacePoint> point_of(double u, double v) const {
    gp_Pnt p;
    gp_Vec du;
    gp_Vec dv;
    adaptor_.D1(u, v, p, du, dv);
    const gp_Vec normal = du.Crossed(dv);
    // At a pole, the parameters do not determine the normal.
    if (!(normal.Magnitude() > 1e-12 * du.Magnitude() * dv.Magnitude()) || !(du.Magnitude() > 0.0)) return std::nullopt;
    const Vec3 n = vector_of(normal.XYZ()) / normal.Magnitude();
    return FacePoint{u, v, vector_of(p.XYZ()), n.z() < 0.0 ? Vec3(-n) : n, n.z() >= 0.0};
  }

  /// Finds out whether the border of the face encloses it in the plane of the parameters. A border around a pole, such
  /// as the vertex of a surface of revolution, may not do so. The whole surface is then searched for points of the
  /// face.
  void find_range() {
    constexpr int kSteps = 16;
    constexpr double kMaxOutside = 0.02;
    int inside = 0;
    int outside_in_plan = 0;
    const double tolerance_mm = 1e-2;
    for (int j = 0; j < kSteps; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const std::optional<FacePoint> point = point_at((i + 0.5) / kSteps, (j + 0.5) / kSteps);
        if (!point) continue;
        ++inside;
        if (!border_in_plan_.covers(point->position.head<2>(), tolerance_mm)) ++outside_in_plan;
      }
    constexpr double kInfinite = 1e50;
    const bool is_finite =
        natural_low_.cwiseAbs().maxCoeff() < kInfinite && natural_high_.cwiseAbs().maxCoeff() < kInfinite;
    has_range_ = !is_finite || (inside > 0 && outside_in_plan <= kMaxOutside * inside);
    if (has_range_) return;
    low_ = natural_low_;
    high_ = natural_high_;
  }

  void sample() {
    constexpr int kMinSteps = 40;
    constexpr int kMaxSteps = 160;
    const int u_steps = std::clamp(4 * adaptor_.NbUIntervals(GeomAbs_CN), kMinSteps, kMaxSteps);
    const int v_steps = std::clamp(4 * adaptor_.NbVIntervals(GeomAbs_CN), kMinSteps, kMaxSteps);
    for (int j = 0; j < v_steps; ++j)
      for (int i = 0; i < u_steps; ++i) {
        const std::optional<FacePoint> p = point_at((i + 0.5) / u_steps, (j + 0.5) / v_steps);
        if (!p) continue;
        if (!p->position.allFinite()) refuse_step("must have faces of finite size");
        if (p->normal.z() < kMinUpwards) refuse_fold(p->position.head<2>());
        if (!samples_.empty() && p->is_along_surface != samples_.front().is_along_surface)
          refuse_fold(p->position.head<2>());
        samples_.push_back(*p);
      }
    if (samples_.empty())
      refuse_step(
          "must have a face that is larger than 0 with one height above each point, but has none: choose "
          "another face, or set rotation_deg so that +z points to the light");
  }

  /// Sorts the samples into square cells in plan.
  void sort_samples() {
    grid_low_ = grid_high_ = samples_.front().position.head<2>();
    for (const FacePoint& sample : samples_) {
      grid_low_ = grid_low_.cwiseMin(sample.position.head<2>());
      grid_high_ = grid_high_.cwiseMax(sample.position.head<2>());
    }
    cells_ = std::max(1, static_cast<int>(std::sqrt(0.25 * static_cast<double>(samples_.size()))));
    of_cell_.assign(static_cast<std::size_t>(cells_ * cells_), {});
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Eigen::Vector2i cell = cell_of(samples_[k].position.head<2>());
      of_cell_[static_cast<std::size_t>(cell.y() * cells_ + cell.x())].push_back(k);
    }
  }

  Eigen::Vector2i cell_of(const Vec2& point) const {
    Eigen::Vector2i cell;
    for (int axis = 0; axis < 2; ++axis) {
      const double size = std::max(grid_high_[axis] - grid_low_[axis], 1e-12);
      const double position = std::clamp((point[axis] - grid_low_[axis]) / size, 0.0, 1.0);
      cell[axis] = std::min(cells_ - 1, static_cast<int>(position * cells_));
    }
    return cell;
  }

  const FacePoint& nearest_sample(const Vec2& point) const {
    const Eigen::Vector2i cell = cell_of(point);
    const FacePoint* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    int last_ring = cells_;
    for (int ring = 0; ring <= last_ring; ++ring)
      for (int j = cell.y() - ring; j <= cell.y() + ring; ++j)
        for (int i = cell.x() - ring; i <= cell.x() + ring; ++i) {
          const bool is_on_ring = std::max(std::abs(i - cell.x()), std::abs(j - cell.y())) == ring;
          if (!is_on_ring || i < 0 || j < 0 || i >= cells_ || j >= cells_) continue;
          for (const std::size_t k : of_cell_[static_cast<std::size_t>(j * cells_ + i)]) {
            const double distance = (samples_[k].position.head<2>() - point).squaredNorm();
            if (!(distance < least)) continue;
            // A nearer sample may be in the next ring.
            if (nearest == nullptr) last_ring = std::min(cells_, ring + 1);
            least = distance;
            nearest = &samples_[k];
          }
        }
    return *nearest;
  }

  static FaceHeight height_with(double z_mm, const Vec3& normal) { return {z_mm, -normal.head<2>() / normal.z()}; }

  std::optional<FaceHeight> at_plane(const Vec2& point) const {
    const gp_Ax3 frame = adaptor_.Plane().Position();
    const Vec3 normal = vector_of(frame.Direction().XYZ());
    const Vec3 origin = vector_of(frame.Location().XYZ());
    const Vec2 slope = -normal.head<2>() / normal.z();
    return FaceHeight{origin.z() + slope.dot(point - origin.head<2>()), slope};
  }

  std::optional<FaceHeight> at_sphere(const Vec2& point) const {
    const gp_Sphere sphere = adaptor_.Sphere();
    const Vec3 centre = vector_of(sphere.Location().XYZ());
    const Vec2 across = point - centre.head<2>();
    const double square = sphere.Radius() * sphere.Radius() - across.squaredNorm();
    if (!(square > kMinUpwards * kMinUpwards * sphere.Radius() * sphere.Radius())) return std::nullopt;
    const double rise = std::copysign(std::sqrt(square), samples_.front().position.z() - centre.z());
    return height_with(centre.z() + rise, {across.x(), across.y(), rise});
  }

  std::optional<FaceHeight> at_cylinder(const Vec2& point) const {
    const gp_Cylinder cylinder = adaptor_.Cylinder();
    const Vec3 centre = vector_of(cylinder.Location().XYZ());
    const Vec3 axis = vector_of(cylinder.Axis().Direction().XYZ());
    const auto across_axis = [&](const Vec3& p) { return Vec3(p - axis.dot(p) * axis); };
    const Vec3 z = across_axis(Vec3::UnitZ());
    // The line through the point parallel to z crosses the cylinder at two points. The face has only one of them.
    const Vec3 start = across_axis({point.x() - centre.x(), point.y() - centre.y(), 0.0});
    const double a = z.squaredNorm();
    if (!(a > 1e-12)) return std::nullopt;
    const double b = z.dot(start);
    const double c = start.squaredNorm() - cylinder.Radius() * cylinder.Radius();
    const double square = b * b - a * c;
    if (!(square > 0.0)) return std::nullopt;
    const Vec3 sample = across_axis(samples_.front().position - centre);
    const double t = (-b + std::copysign(std::sqrt(square), z.dot(sample))) / a;
    const Vec3 normal = start + t * z;
    if (!(std::abs(normal.z()) > kMinUpwards * normal.norm())) return std::nullopt;
    return height_with(centre.z() + t, normal);
  }

  /// Returns the height of a surface whose parameters are found by Newton's method, which begins at the nearest sample.
  std::optional<FaceHeight> by_search(const Vec2& point) const {
    if (const std::optional<FaceHeight> height = search(point)) return height;
    // At a pole, such as the vertex of a surface of revolution, the method fails. It is repeated beside the pole.
    const double beside = 1e-8 * (grid_high_ - grid_low_).norm();
    const std::optional<FaceHeight> height = search(point + Vec2(beside, 0.7 * beside));
    if (!height) return std::nullopt;
    return FaceHeight{height->z_mm - height->slope.dot(Vec2(beside, 0.7 * beside)), height->slope};
  }

  std::optional<FaceHeight> search(const Vec2& point) const {
    constexpr int kMaxSteps = 50;
    constexpr double kMaxStep = 0.2;  // fraction of the range of parameters
    constexpr double kBeyond = 0.1;   // continuation of the surface, as a fraction of its range of parameters
    const double accuracy = 4e-15 * (point.norm() + (grid_high_ - grid_low_).norm());
    const FacePoint& start = nearest_sample(point);
    Vec2 uv(start.u, start.v);
    const Vec2 range = high_ - low_;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kMaxSteps; ++k) {
      gp_Pnt p;
      gp_Vec du;
      gp_Vec dv;
      adaptor_.D1(uv.x(), uv.y(), p, du, dv);
      Eigen::Matrix2d derivative;
      derivative << du.X(), dv.X(), du.Y(), dv.Y();
      const Vec2 rest = point - Vec2(p.X(), p.Y());
      const double distance = rest.norm();
      const double determinant = derivative.determinant();
      if (!(std::abs(determinant) > 1e-14 * derivative.col(0).norm() * derivative.col(1).norm()) ||
          !std::isfinite(distance))
        return std::nullopt;
      // The distance no longer decreases when it is as small as the rounding errors.
      if (distance <= accuracy || (distance < 1e3 * accuracy && distance >= 0.5 * before)) {
        const gp_Vec normal = du.Crossed(dv);
        if (!(std::abs(normal.Z()) > kMinUpwards * normal.Magnitude())) return std::nullopt;
        const Vec2 slope(-normal.X() / normal.Z(), -normal.Y() / normal.Z());
        return FaceHeight{p.Z() + slope.dot(rest), slope};
      }
      before = distance;
      Vec2 step = derivative.inverse() * rest;
      const double length = step.cwiseQuotient(range).cwiseAbs().maxCoeff();
      if (length > kMaxStep) step *= kMaxStep / length;
      uv += step;
      for (int axis = 0; axis < 2; ++axis) {
        if (is_periodic_[static_cast<std::size_t>(axis)] || std::abs(natural_low_[axis]) > 1e50 ||
            std::abs(natural_high_[axis]) > 1e50)
          continue;
        const double room = kBeyond * (natural_high_[axis] - natural_low_[axis]);
        uv[axis] = std::clamp(uv[axis], natural_low_[axis] - room, natural_high_[axis] + room);
      }
    }
    return std::nullopt;
  }

  Handle(Geom_Surface) surface_;
  GeomAdaptor_Surface adaptor_;
  BRepTopAdaptor_FClass2d border_;
  PatchSurface border_in_plan_;
  bool has_range_ = true;    ///< true if the border encloses the face in the plane of the parameters
  Vec2 low_ = Vec2::Zero();  ///< range of parameters of the face
  Vec2 high_ = Vec2::Zero();
  Vec2 natural_low_ = Vec2::Zero();  ///< range of parameters of the surface
  Vec2 natural_high_ = Vec2::Zero();
  std::array<bool, 2> is_periodic_{};
  std::vector<FacePoint> samples_;
  Vec2 grid_low_ = Vec2::Zero();
  Vec2 grid_high_ = Vec2::Zero();
  int cells_ = 1;
  std::vector<std::vector<std::size_t>> of_cell_;
};

/// Rectangle in plan.
struct GridCell {
  Vec2 centre;
  Vec2 half;
};

/// Allowed differences between a patch and its face.
struct Allowed {
  double height_mm;
  double slope;
};
// Large patches must be much more accurate than required, because a smooth face needs few of them. Small patches are
// needed at knots of B-splines, where a polynomial does not converge fast.
constexpr Allowed kOfLargePatch = {1e-9, 5e-9};
constexpr Allowed kOfSmallPatch = {2e-7, 1e-7};

/// Divides the plan of a face into rectangles, and fits a polynomial on each of them.
class TreeMaker {
 public:
  /// \param margin_mm distance by which the patches continue beyond the border
  TreeMaker(const FaceHeights& face, const FaceBorder& border, const Vec3& origin_mm, double margin_mm, double size_mm)
      : face_(face), border_(border), origin_(origin_mm), margin_mm_(margin_mm), size_mm_(size_mm) {
    // Rows are the powers of the nodes.
    Eigen::Matrix<double, kNodes, kNodes> powers;
    for (int k = 0; k < kNodes; ++k) {
      nodes_[static_cast<std::size_t>(k)] = std::cos(std::numbers::pi * (k + 0.5) / kNodes);
      for (int i = 0; i < kNodes; ++i) powers(k, i) = std::pow(nodes_[static_cast<std::size_t>(k)], i);
    }
    coefficients_of_ = powers.fullPivLu().inverse();
  }

  PatchTree make(std::size_t patches_of_others) {
    others_ = patches_of_others;
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
    Vec2 high = -low;
    std::vector<Side> sides;
    for (const std::vector<Vec2>& loop : border_)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        low = low.cwiseMin(loop[k]);
        high = high.cwiseMax(loop[k]);
        sides.push_back({loop[k], loop[(k + 1) % loop.size()]});
      }
    if (sides.empty()) refuse_step("must have faces with a border");
    low.array() -= margin_mm_;
    high.array() += margin_mm_;
    tree_.nodes.emplace_back();
    divide(0, {0.5 * (low + high), 0.5 * (high - low)}, sides);
    return std::move(tree_);
  }

 private:
  struct Side {
    Vec2 from;
    Vec2 to;
  };

  bool is_inside(const Vec2& point) const {
    bool inside = false;
    for (const std::vector<Vec2>& loop : border_)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2& a = loop[k];
        const Vec2& b = loop[(k + 1) % loop.size()];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > point.x()) inside = !inside;
      }
    return inside;
  }

  /// Returns the sides of the border whose distance from a cell may be less than `margin_mm`.
  static std::vector<Side> sides_near(const std::vector<Side>& sides, const GridCell& cell, double margin_mm) {
    const double reach = cell.half.norm() + 1.5 * margin_mm;
    std::vector<Side> near;
    for (const Side& side : sides) {
      const Vec2 along = side.to - side.from;
      const double length2 = along.squaredNorm();
      const double fraction = length2 > 0.0 ? std::clamp(along.dot(cell.centre - side.from) / length2, 0.0, 1.0) : 0.0;
      if ((side.from + fraction * along - cell.centre).norm() <= reach) near.push_back(side);
    }
    return near;
  }

  void divide(std::uint32_t node, const GridCell& cell, const std::vector<Side>& sides_around) {
    constexpr double kMinSize = 1.0 / 16384.0;
    // Beyond the border, the surface may end. Cells near the border must reach it, but cells further away need not.
    constexpr double kMinSizeBeyond = 1.0 / 1024.0;
    constexpr double kMinSizeFarBeyond = 1.0 / 64.0;
    const std::vector<Side> sides = sides_near(sides_around, cell, margin_mm_);
    const bool is_within = is_inside(cell.centre);
    if (sides.empty() && !is_within) return;  // there is no surface
    int axis = cell.half.x() >= cell.half.y() ? 0 : 1;
    if (fit(cell, axis)) {
      tree_.nodes[node].first = static_cast<std::uint32_t>(tree_.patches.size() - 1);
      if (others_ + tree_.patches.size() > kMaxPatches)
        refuse_step("must have smoother faces: more than " + std::to_string(kMaxPatches) +
                    " polynomials are needed to approximate them within 1 nm and 0.1 arcsec");
      return;
    }
    const bool is_near = is_within || !sides_near(sides, cell, step_margin_mm(Vec2::Constant(size_mm_))).empty();
    if (cell.half.maxCoeff() < (is_near ? kMinSizeBeyond : kMinSizeFarBeyond) * size_mm_ && !is_within) return;
    if (cell.half.minCoeff() < kMinSize * size_mm_) {
      const std::optional<FaceHeight> height = face_.at(cell.centre);
      if (!height) refuse_fold(cell.centre);
      refuse_step("must have smooth faces, but no polynomial approximates the face within 1 nm and 0.1 arcsec near " +
                  place_of(cell.centre) + " of the rotated file");
    }
    const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(tree_.nodes.size() + 2);
    tree_.nodes[node] = {axis, first, first + 1, cell.centre[axis] - origin_[axis]};
    for (const std::uint32_t side : {0U, 1U}) {
      GridCell part = cell;
      part.half[axis] *= 0.5;
      part.centre[axis] += (side == 0U ? -1.0 : 1.0) * part.half[axis];
      divide(first + side, part, sides);
    }
  }

  /// Fits a polynomial to the face on a cell, and adds it to the tree if it is accurate.
  /// \param axis set to the axis along which the cell should be divided otherwise
  bool fit(const GridCell& cell, int& axis) {
    Eigen::Matrix<double, kNodes, kNodes> heights;
    for (int i = 0; i < kNodes; ++i)
      for (int j = 0; j < kNodes; ++j) {
        const Vec2 at(nodes_[static_cast<std::size_t>(i)], nodes_[static_cast<std::size_t>(j)]);
        const std::optional<FaceHeight> height = face_.at(cell.centre + at.cwiseProduct(cell.half));
        if (!height) return false;
        heights(i, j) = height->z_mm - origin_.z();
      }
    const Eigen::Matrix<double, kNodes, kNodes> c = coefficients_of_ * heights * coefficients_of_.transpose();
    // The cell is divided along the axis with the larger terms of high degree.
    const double x_terms = c.bottomRows<2>().cwiseAbs().sum();
    const double y_terms = c.rightCols<2>().cwiseAbs().sum();
    if (x_terms > 4.0 * y_terms && cell.half.x() > 0.02 * cell.half.y()) axis = 0;
    if (y_terms > 4.0 * x_terms && cell.half.y() > 0.02 * cell.half.x()) axis = 1;
    HeightPatch patch;
    patch.centre_mm = cell.centre - origin_.head<2>();
    patch.half_mm = cell.half;
    for (int i = 0; i < kNodes; ++i)
      for (int j = 0; j < kNodes; ++j) patch.coefficients[static_cast<std::size_t>(i * kNodes + j)] = c(i, j);
    constexpr double kLargePatch = 1.0 / 40.0;
    const Allowed allowed = cell.half.maxCoeff() > kLargePatch * size_mm_ ? kOfLargePatch : kOfSmallPatch;
    if (!is_accurate(cell, patch, allowed)) return false;
    tree_.patches.push_back(patch);
    return true;
  }

  bool is_accurate(const GridCell& cell, const HeightPatch& patch, const Allowed& allowed) const {
    // These points are not nodes, and include the border of the cell.
    constexpr std::array<double, 7> kAt = {-1.0, -0.9, -0.37, 0.07, 0.47, 0.91, 1.0};
    for (const double u : kAt)
      for (const double v : kAt) {
        const std::optional<FaceHeight> exact = face_.at(cell.centre + Vec2(u, v).cwiseProduct(cell.half));
        if (!exact) return false;
        const Vec2 at = patch.centre_mm + Vec2(u, v).cwiseProduct(patch.half_mm);
        const Gradient z = patch.evaluate(Gradient(at.x(), 1.0, 0.0), Gradient(at.y(), 0.0, 1.0));
        if (!(std::abs(z.value + origin_.z() - exact->z_mm) <= allowed.height_mm) ||
            !((Vec2(z.x, z.y) - exact->slope).norm() <= allowed.slope))
          return false;
      }
    return true;
  }

  const FaceHeights& face_;
  const FaceBorder& border_;
  Vec3 origin_;
  double margin_mm_;
  double size_mm_;
  std::size_t others_ = 0;
  std::array<double, kNodes> nodes_{};
  Eigen::Matrix<double, kNodes, kNodes> coefficients_of_;  ///< polynomial coefficients for values at the nodes
  PatchTree tree_;
};

/// Returns a number in 0..1 that belongs to a sequence without regularity (M. Roberts, "The unreasonable effectiveness
/// of quasirandom sequences", 2018).
double fraction_of(int k, double step) {
  const double value = 0.5 + k * step;
  return value - std::floor(value);
}

/// Compares patches with the surface of their face at points that were not used to make them.
void measure(FaceHeights& face, const PatchTree& tree, std::size_t faces, FittedFaces& fitted) {
  const int points = std::max(2000, static_cast<int>(20000 / faces));
  for (int k = 0; k < points; ++k) {
    const std::optional<FacePoint> exact =
        face.point_at(fraction_of(k, 0.7548776662466927), fraction_of(k, 0.5698402909980532));
    if (!exact) continue;
    const Vec2 at = exact->position.head<2>() - fitted.origin_mm.head<2>();
    const HeightPatch* const patch = tree.patch_at(at);
    if (patch == nullptr) refuse_fold(exact->position.head<2>());
    const Gradient z = patch->evaluate(Gradient(at.x(), 1.0, 0.0), Gradient(at.y(), 0.0, 1.0));
    const double difference_mm = std::abs(z.value + fitted.origin_mm.z() - exact->position.z());
    constexpr double kOtherSheetMm = 1e-3;
    if (!(difference_mm < kOtherSheetMm)) refuse_fold(exact->position.head<2>());
    const Vec3 normal = Vec3(-z.x, -z.y, 1.0).normalized();
    fitted.deviation_mm = std::max(fitted.deviation_mm, difference_mm);
    fitted.deviation_arcsec = std::max(fitted.deviation_arcsec, kArcsecPerRad * normal.cross(exact->normal).norm());
  }
}

/// Exact bounding box of the borders in plan.
struct PlanBox {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = Vec2::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Adds a line or an arc to a bounding box.
void add_side(PlanBox& box, const OutlineSide& side) {
  box.add(side.from_mm);
  box.add(side.to_mm);
  if (!side.is_arc()) return;
  const double b = side.bulge;
  const Vec2 chord = side.to_mm - side.from_mm;
  const Vec2 left(-chord.y(), chord.x());
  const Vec2 centre = 0.5 * (side.from_mm + side.to_mm) + (1.0 - b * b) / (4.0 * b) * left;
  const double radius = 0.25 * chord.norm() * (1.0 + b * b) / std::abs(b);
  for (const Vec2& direction : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
    const Vec2 p = centre + radius * direction;
    // The arc is on the right of its chord if the bulge is positive, otherwise on the left.
    const double to_left = left.dot(p - side.from_mm);
    if (b > 0.0 ? to_left < 0.0 : to_left > 0.0) box.add(p);
  }
}

PlanBox box_of(const std::vector<OutlineLoop>& loops) {
  PlanBox box;
  for (const OutlineLoop& loop : loops)
    for (const OutlineSide& side : loop) add_side(box, side);
  return box;
}

}  // namespace

FittedFaces fit_faces(const ChosenFaces& chosen, const StepChoice& choice) {
  constexpr double kMinSizeMm = 1e-3;
  constexpr double kMaxSizeMm = 1e5;
  // The polygon of a single face is used only to find out which cells the face covers. At edges between faces, it
  // determines the position of the edge.
  const double border_mm = chosen.faces.size() == 1 ? 1e-3 : 5e-7;
  FittedFaces fitted;
  fitted.patches.borders = borders_of(chosen, border_mm);
  std::deque<FaceHeights> faces;
  for (std::size_t k = 0; k < chosen.faces.size(); ++k) faces.emplace_back(chosen.faces[k], fitted.patches.borders[k]);
  const PlanBox box = box_of(loops_around(chosen, choice.sew_mm));
  fitted.size_mm = box.high - box.low;
  const double size_mm = fitted.size_mm.maxCoeff();
  if (!(size_mm >= kMinSizeMm && size_mm <= kMaxSizeMm)) {
    std::ostringstream text;
    text << "must have faces of 0.001 mm to 100000 mm, but they are " << size_mm
         << " mm large: check its unit, which is " << chosen.unit;
    refuse_step(text.str());
  }
  if (choice.origin_mm) {
    const std::array<double, 3>& o = *choice.origin_mm;
    fitted.origin_mm = rotation_of(choice) * Vec3(o[0], o[1], o[2]);
  } else {
    const Vec2 centre = 0.5 * (box.low + box.high);
    fitted.origin_mm = {centre.x(), centre.y(), faces.front().middle_z_mm()};
    for (std::size_t k = 0; k < faces.size(); ++k)
      if (PatchSurface({PatchTree{}}, {fitted.patches.borders[k]}).covers(centre, 1e-3))
        if (const std::optional<FaceHeight> height = faces[k].at(centre)) fitted.origin_mm.z() = height->z_mm;
  }
  // Photometry evaluates the surface over whole elements, which may extend beyond the border of the face.
  constexpr double kMargin = 0.1;
  const double margin_mm = kMargin * size_mm;
  std::size_t patches = 0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    TreeMaker maker(faces[k], fitted.patches.borders[k], fitted.origin_mm, margin_mm, size_mm);
    fitted.patches.faces.push_back(maker.make(patches));
    patches += fitted.patches.faces.back().patches.size();
    measure(faces[k], fitted.patches.faces.back(), faces.size(), fitted);
  }
  if (fitted.deviation_mm > kMaxStepDeviationMm || fitted.deviation_arcsec > kMaxStepDeviationArcsec) {
    std::ostringstream text;
    text << "must have smooth faces, but their approximation differs by " << 1e6 * fitted.deviation_mm << " nm and "
         << fitted.deviation_arcsec << " arcsec (allowed: 1 nm, 0.1 arcsec)";
    refuse_step(text.str());
  }
  for (FaceBorder& border : fitted.patches.borders)
    for (std::vector<Vec2>& loop : border)
      for (Vec2& p : loop) p -= fitted.origin_mm.head<2>();
  return fitted;
}

}  // namespace retrace::geometry
