#include "surface_models/scatter/first_order.h"

#include <algorithm>
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <numbers>
#include <optional>
#include <vector>

namespace retrace::surface_models {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

double square(double x) {
  return x * x;
}

/// Amplitude factors of the total field at an interface, for light from the side with the index `from`.
struct Total {
  Complex electric;  ///< 1 + r for s
  Complex magnetic;  ///< 1 + r for p, where r is the coefficient of the magnetic field
};
Total total(double from, Complex across_from, double to, Complex across_to) {
  const double from2 = from * from, to2 = to * to;
  return {2.0 * across_from / (across_from + across_to),
          2.0 * to2 * across_from / (to2 * across_from + from2 * across_to)};
}

/// Values of |F|^2 for incident s and p and scattered s and p, as functions of the angle phi between the two wave
/// vectors.
struct Squares {
  double ss, sp, ps;     ///< the second letter is the incident polarisation
  double pp, mixed, nn;  ///< |a cos phi + b|^2 = pp cos^2 + mixed cos + nn

  Squares(const DielectricInterface::Vertex& in, const DielectricInterface::Vertex& out, double factor)
      : ss(factor * std::norm(in.s * out.s)),
        sp(factor * std::norm(in.p * out.s)),
        ps(factor * std::norm(in.s * out.p)),
        pp(factor * std::norm(in.p * out.p)),
        mixed(factor * 2.0 * std::real(in.p * out.p * std::conj(in.across * out.across))),
        nn(factor * std::norm(in.across * out.across)) {}

  Squares& operator+=(const Squares& o) {
    ss += o.ss, sp += o.sp, ps += o.ps, pp += o.pp, mixed += o.mixed, nn += o.nn;
    return *this;
  }
};

/// Returns the scattered power for one incident wave vector, integrated over both sides.
std::array<double, 2> scattered_fraction(const DielectricInterface& interface, double length, double k_in) {
  using boost::math::quadrature::gauss;
  const double variance = 2.0 / (length * length);  // variance of the shift of k along each axis
  const double reach = 6.5 * std::sqrt(variance);   // less than 1e-9 is beyond this distance
  const double contrast2 = square(square(interface.index_to()) - square(interface.index_from()));
  const double q_in = interface.across(k_in, Lobe::reflection).real();
  const DielectricInterface::Vertex in = interface.arriving(k_in);
  std::array<double, 2> sum{};
  const auto ring = [&](double k) {
    std::optional<Squares> squares;
    for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
      if (k >= interface.index_of(lobe)) continue;
      const double q_out = interface.across(k, lobe).real();
      const Squares more(in, interface.leaving(k, lobe), contrast2 / (4.0 * q_in * q_out));
      squares ? void(*squares += more) : void(squares = more);
    }
    std::array<double, 2> found{};
    if (!squares) return found;
    const double chord = 0.5 * reach / std::sqrt(std::max(k * k_in, 1e-300));
    const double widest = 2.0 * std::asin(std::min(1.0, chord));
    const auto add = [&](double phi, double weight) {
      const double half = square(std::sin(0.5 * phi)), c = 1.0 - 2.0 * half, c2 = c * c;
      const double shift2 = square(k - k_in) + 4.0 * k * k_in * half;
      const double density = weight * std::exp(-0.5 * shift2 / variance);
      found[0] += density * (squares->ss * c2 + squares->ps * (1.0 - c2));
      found[1] += density * (squares->sp * (1.0 - c2) + squares->pp * c2 + squares->mixed * c + squares->nn);
    };
    const auto& nodes = gauss<double, 20>::abscissa();
    const auto& weights = gauss<double, 20>::weights();
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (const double side : {-1.0, 1.0}) add(0.5 * widest * (1.0 + side * nodes[n]), 0.5 * widest * weights[n]);
    return found;
  };
  const double most = std::max(interface.index_from(), interface.index_to());
  const double least = std::min(interface.index_from(), interface.index_to());
  std::array<double, 5> borders = {std::max(0.0, k_in - reach), k_in, least, most, std::min(most, k_in + reach)};
  std::sort(borders.begin(), borders.end());
  const auto& nodes = gauss<double, 20>::abscissa();
  const auto& weights = gauss<double, 20>::weights();
  for (std::size_t b = 1; b < borders.size(); ++b) {
    const double from = std::max(borders[b - 1], k_in - reach), to = std::min(borders[b], k_in + reach);
    if (to <= from) continue;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (const double side : {-1.0, 1.0}) {
        // k is expressed as from + (to - from) sin^2. Square roots at the ends of the range then become smooth
        // functions.
        const double u = 0.5 * pi * 0.5 * (1.0 + side * nodes[n]);
        const double k = from + (to - from) * square(std::sin(u));
        const std::array<double, 2> found = ring(k);
        const double weight = 0.25 * pi * weights[n] * (to - from) * std::sin(2.0 * u) * k / (pi * variance);
        sum[0] += weight * found[0];
        sum[1] += weight * found[1];
      }
  }
  return sum;
}

}  // namespace

DielectricInterface::DielectricInterface(double index_from, double index_to)
    : index_from_(index_from), index_to_(index_to), contrast_(index_to * index_to - index_from * index_from) {}

Complex DielectricInterface::across(double k, Lobe lobe) const {
  const double n = index_of(lobe);
  const double q2 = (n - k) * (n + k);
  return q2 >= 0.0 ? Complex(std::sqrt(q2)) : Complex(0.0, std::sqrt(-q2));
}

DielectricInterface::Vertex DielectricInterface::arriving(double k) const {
  const Complex q_from = across(k, Lobe::reflection), q_to = across(k, Lobe::transmission);
  const Total t = total(index_from_, q_from, index_to_, q_to);
  const Complex h = index_from_ * t.magnetic;
  return {t.electric, -q_to / square(index_to_) * h, -k * h / (index_from_ * index_to_)};
}

DielectricInterface::Vertex DielectricInterface::leaving(double k, Lobe lobe) const {
  const Lobe other = lobe == Lobe::reflection ? Lobe::transmission : Lobe::reflection;
  const double from = index_of(lobe), to = index_of(other);
  const Complex q_to = across(k, other);
  const Total t = total(from, across(k, lobe), to, q_to);
  const Complex h = from * t.magnetic;
  const double sign = lobe == Lobe::reflection ? 1.0 : -1.0;
  return {t.electric, sign * q_to / square(to) * h, -k * h / (from * to)};
}

Polarisation2 DielectricInterface::amplitudes(double k_in, const Vec2& along, const Vec2& k_out, Lobe lobe) const {
  const double k = k_out.norm();
  const Vec2 out_along = k > 0.0 ? Vec2(k_out / k) : along;
  const double c = along.dot(out_along);
  const double s = along.x() * out_along.y() - along.y() * out_along.x();
  const Vertex in = arriving(k_in), out = leaving(k, lobe);
  const double factor = 0.5 * contrast_ / std::sqrt(across(k_in, Lobe::reflection).real() * across(k, lobe).real());
  Polarisation2 f;
  f(0, 0) = in.s * out.s * c;
  f(0, 1) = in.p * out.s * s;
  f(1, 0) = -in.s * out.p * s;
  f(1, 1) = in.p * out.p * c + in.across * out.across;
  return factor * f;
}

double DielectricInterface::bound(double k_in, const Polarisation2& coherency) const {
  // The bound follows from the Cauchy-Schwarz inequality. It uses the squared field of the scattered light, divided by
  // q (the normal component of its wave vector) and added over both sides. This sum is largest at the critical angle
  // (docs/theory/scatter.md).
  const Vertex in = arriving(k_in);
  const double felt =
      std::norm(in.s) * coherency(0, 0).real() + (std::norm(in.p) + std::norm(in.across)) * coherency(1, 1).real();
  const double root = std::sqrt(std::abs(contrast_));
  return root * root * root * felt / across(k_in, Lobe::reflection).real();
}

struct FirstOrderFraction::Table {
  using Spline = boost::math::interpolators::cardinal_cubic_b_spline<double>;
  /// Range of k_in in which the fractions are smooth functions of an angle psi in 0..pi/2: k^2 = low2 + (high2 - low2)
  /// sin^2 psi.
  struct Range {
    double low2 = 0.0, high2 = 0.0;
    Spline s, p;
  };
  std::vector<Range> ranges;  ///< up to the critical angle, and beyond it if there is one

  void add(const DielectricInterface& interface, double length, double low, double high) {
    constexpr std::size_t kNodes = 97;
    constexpr double kStep = 0.5 * pi / (kNodes - 1);
    Range range;
    range.low2 = low * low;
    range.high2 = high * high;
    std::vector<double> s(kNodes, 0.0), p(kNodes, 0.0);
    for (std::size_t n = 0; n < kNodes; ++n) {
      const double sine = std::sin(kStep * static_cast<double>(n));
      const double k = std::sqrt(range.low2 + (range.high2 - range.low2) * sine * sine);
      if (k >= interface.index_from()) continue;  // light at grazing incidence is not scattered
      const std::array<double, 2> found = scattered_fraction(interface, length, k);
      s[n] = found[0];
      p[n] = found[1];
    }
    range.s = Spline(s.data(), kNodes, 0.0, kStep);
    range.p = Spline(p.data(), kNodes, 0.0, kStep);
    ranges.push_back(std::move(range));
  }
};

FirstOrderFraction::FirstOrderFraction(const DielectricInterface& interface, double correlation_length) {
  auto table = std::make_shared<Table>();
  const double least = std::min(interface.index_from(), interface.index_to());
  table->add(interface, correlation_length, 0.0, least);
  if (interface.index_from() > least) table->add(interface, correlation_length, least, interface.index_from());
  table_ = std::move(table);
}

std::array<double, 2> FirstOrderFraction::at(double k_in) const {
  const Table::Range& range =
      k_in * k_in <= table_->ranges.front().high2 ? table_->ranges.front() : table_->ranges.back();
  const double sine2 = (k_in * k_in - range.low2) / (range.high2 - range.low2);
  const double psi = std::asin(std::sqrt(std::clamp(sine2, 0.0, 1.0)));
  return {std::max(0.0, range.s(psi)), std::max(0.0, range.p(psi))};
}

}  // namespace retrace::surface_models
