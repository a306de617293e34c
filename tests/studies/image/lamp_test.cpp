// Tests of lamps from photometric files: intensity as a function of the direction, flux, and refused files.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/number_format.h"
#include "core/text.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/image/road_study.h"
#include "tests/support/refusals.h"

namespace retrace::studies::lamp_test {
namespace {

using geometry::Vec3;
using Planes = LuminousIntensity::Planes;
using std::numbers::pi;

constexpr double kRadPerDeg = pi / 180.0;

std::vector<double> steps(double from, double to, double step) {
  std::vector<double> values;
  for (int k = 0; from + k * step <= to + 1e-9; ++k) values.push_back(from + k * step);
  return values;
}

std::string words(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += shortest(value) + " ";
  return text + "\n";
}

using Candela = std::function<double(double plane_deg, double angle_deg)>;

/// Returns an IES file with these planes and angles. Each plane is one line.
/// \param type 1: planes C, 2: planes B, 3: planes A
std::string ies(int type, const std::vector<double>& planes, const std::vector<double>& angles, const Candela& cd,
                const std::string& first = "IESNA:LM-63-2002\n", const std::string& factors = "1 1 60") {
  std::string text = first + "[LUMINAIRE] A lamp\nTILT=NONE\n1 1000 2 " + std::to_string(angles.size()) + " " +
                     std::to_string(planes.size()) + " " + std::to_string(type) + " 2 0 0 0\n" + factors + "\n" +
                     words(angles) + words(planes);
  for (const double plane : planes) {
    std::vector<double> row;
    for (const double angle : angles) row.push_back(0.5 * cd(plane, angle));  // the factor in the file is 2
    text += words(row);
  }
  return text;
}

std::string ldt(int symmetry, double step_c_deg, const std::vector<double>& angles, const Candela& cd,
                const std::vector<double>& written_planes) {
  const std::vector<double> planes = steps(0, 360 - step_c_deg, step_c_deg);
  std::string text = "Company\n1\n" + std::to_string(symmetry) + "\n" + std::to_string(planes.size()) + "\n" +
                     shortest(step_c_deg) + "\n" + std::to_string(angles.size()) +
                     "\n5\nreport\nA lamp\nno\nfile\ndate\n" +
                     "100\n0\n50\n80\n0\n0\n0\n0\n0\n100\n80\n1.0\n0\n1\n1\ntype\n2000\nwhite\n80\n60\n" +
                     "0.1\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n0.8\n0.9\n1\n";
  for (const double plane : planes) text += shortest(plane) + "\n";
  for (const double angle : angles) text += shortest(angle) + "\n";
  for (const double plane : written_planes)
    // The file gives cd per 1000 lm, and the lamp has 2000 lm.
    for (const double angle : angles) text += shortest(cd(plane, angle) / 2.0) + "\n";
  return text;
}

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

/// Expects equal intensities in 500 random directions, and equal flux.
void expect_same(const LuminousIntensity& a, const LuminousIntensity& b) {
  std::mt19937 random(1);
  for (int k = 0; k < 500; ++k) {
    const Vec3 direction = random_direction(random);
    EXPECT_NEAR(a.cd(direction), b.cd(direction), 1e-9 * a.largest_cd()) << direction.transpose();
  }
  EXPECT_NEAR(a.lumens(), b.lumens(), 1e-9 * a.lumens());
}

const Candela kPlain = [](double, double) { return 100.0; };

TEST(Lamp, EvenOnesHaveTheFluxOfASphere) {
  const std::vector<double> whole = steps(0, 180, 10);
  EXPECT_NEAR(parse_ies(ies(1, {0}, whole, kPlain), "a.ies").intensity.lumens(), 400.0 * pi, 1e-9);
  EXPECT_NEAR(parse_ies(ies(1, steps(0, 360, 30), whole, kPlain), "a.ies").intensity.lumens(), 400.0 * pi, 1e-9);
  EXPECT_NEAR(parse_ies(ies(3, steps(-180, 180, 30), steps(-90, 90, 10), kPlain), "a.ies").intensity.lumens(),
              400.0 * pi, 1e-9);
  // Type B files give planes that all contain the horizontal axis. From -90 to 90 degrees they cover the half space
  // ahead. The angles of these planes are the vertical angles of the file.
  EXPECT_NEAR(parse_ies(ies(2, steps(-90, 90, 30), steps(-90, 90, 10), kPlain), "a.ies").intensity.lumens(), 200.0 * pi,
              1e-9);
  EXPECT_NEAR(parse_ldt(ldt(1, 30, whole, kPlain, {0}), "a.ldt").intensity.lumens(), 400.0 * pi, 1e-9);
}

TEST(Lamp, FluxIsTheIntegralOfItsIntensity) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1000.0);
  for (const Planes kind : {Planes::c, Planes::a, Planes::b}) {
    const std::vector<double> planes = kind == Planes::c ? steps(0, 360, 45) : steps(-80, 80, 40);
    const std::vector<double> angles = kind == Planes::c ? steps(0, 120, 20) : steps(-60, 80, 20);
    std::vector<double> cd(planes.size() * angles.size());
    for (double& value : cd) value = uniform(random);
    if (kind == Planes::c)
      std::copy_n(cd.begin(), angles.size(), cd.end() - static_cast<std::ptrdiff_t>(angles.size()));
    const LuminousIntensity lamp(kind, planes, angles, cd);
    // The directions are on a spiral that is uniformly distributed over the sphere.
    constexpr int kDirections = 400'000;
    const double golden = pi * (3.0 - std::sqrt(5.0));
    double mean = 0.0;
    for (int k = 0; k < kDirections; ++k) {
      const double z = 1.0 - 2.0 * (k + 0.5) / kDirections;
      const double r = std::sqrt(1.0 - z * z);
      mean += lamp.cd(Vec3(r * std::cos(golden * k), r * std::sin(golden * k), z)) / kDirections;
    }
    EXPECT_NEAR(lamp.lumens(), 4.0 * pi * mean, 1e-3 * lamp.lumens()) << static_cast<int>(kind);
  }
}

TEST(Lamp, DirectionsAreThoseOfItsPlanes) {
  const auto towards = [](double right_deg, double up_deg) {  // azimuth and elevation
    return Vec3(std::cos(up_deg * kRadPerDeg) * std::sin(right_deg * kRadPerDeg), std::sin(up_deg * kRadPerDeg),
                -std::cos(up_deg * kRadPerDeg) * std::cos(right_deg * kRadPerDeg));
  };
  const Candela sum = [](double plane, double angle) { return 1000.0 + 10.0 * plane + angle; };
  const auto a = parse_ies(ies(3, steps(-60, 60, 10), steps(-50, 50, 10), sum), "a.ies").intensity;
  EXPECT_NEAR(a.cd(towards(20, 5)), 1205.0, 1e-9);
  EXPECT_NEAR(a.cd(towards(-20, -5)), 795.0, 1e-9);
  EXPECT_EQ(a.cd(towards(61, 0)), 0.0);
  EXPECT_EQ(a.cd(towards(0, 51)), 0.0);
  EXPECT_EQ(a.cd(towards(180, 0)), 0.0);
  // In type B files, the horizontal angle is the angle within a plane. In this test file, it selects the row.
  const auto b = parse_ies(ies(2, steps(-60, 60, 10), steps(-50, 50, 10), sum), "a.ies").intensity;
  EXPECT_NEAR(b.cd(towards(0, 5)), 1005.0, 1e-9);
  EXPECT_NEAR(b.cd(towards(20, 0)), 1200.0, 1e-9);
  const double v = 30.0 * kRadPerDeg;
  const double h = 20.0 * kRadPerDeg;
  EXPECT_NEAR(b.cd(Vec3(std::sin(h), std::cos(h) * std::sin(v), -std::cos(h) * std::cos(v))), 1230.0, 1e-9);
  const auto c =
      parse_ies(ies(1, steps(0, 360, 10), steps(0, 90, 10),
                    [](double plane, double angle) { return std::fmod(plane, 360.0) + 1000.0 * (angle / 90.0); }),
                "a.ies")
          .intensity;
  EXPECT_NEAR(c.cd(towards(90, 0)), 1000.0, 1e-9);        // C = 0: right
  EXPECT_NEAR(c.cd(towards(0, 45)), 90.0 + 500.0, 1e-9);  // C = 90: up
  EXPECT_NEAR(c.cd(towards(-45, 0)), 180.0 + 500.0, 1e-9);
  EXPECT_NEAR(c.cd(towards(0, -45)), 270.0 + 500.0, 1e-9);
  // If the axis of the lamp points 10 degrees down, the direction 10 degrees below the horizon is on the axis.
  EXPECT_NEAR(a.cd(from_aimed(towards(0, -10), 10.0)), a.cd(towards(0, 0)), 1e-9);
  EXPECT_NEAR(a.cd(from_aimed(towards(0, 0), 10.0)), a.cd(towards(0, 10)), 1e-9);
}

TEST(Lamp, SymmetriesSayTheSame) {
  const std::vector<double> angles = steps(0, 90, 15);
  const Candela both = [](double plane, double angle) {
    return 500.0 + 300.0 * std::cos(2.0 * plane * kRadPerDeg) * std::sin(angle * kRadPerDeg);
  };
  const Candela left_right = [](double plane, double angle) {  // symmetric about C90 - C270
    return 500.0 + 300.0 * std::sin(plane * kRadPerDeg) * std::sin(angle * kRadPerDeg);
  };
  const Candela up_down = [](double plane, double angle) {  // symmetric about C0 - C180
    return 500.0 + 300.0 * std::cos(plane * kRadPerDeg) * std::sin(angle * kRadPerDeg);
  };
  const auto of_ies = [&](const std::vector<double>& planes, const Candela& cd) {
    return parse_ies(ies(1, planes, angles, cd), "a.ies").intensity;
  };
  const auto of_ldt = [&](int symmetry, const std::vector<double>& planes, const Candela& cd) {
    return parse_ldt(ldt(symmetry, 15, angles, cd, planes), "a.ldt").intensity;
  };
  const std::vector<double> turn = steps(0, 360, 15);
  expect_same(of_ies(turn, both), of_ies(steps(0, 90, 15), both));
  expect_same(of_ies(turn, both), of_ldt(4, steps(0, 90, 15), both));
  expect_same(of_ies(turn, up_down), of_ies(steps(0, 180, 15), up_down));
  expect_same(of_ies(turn, up_down), of_ldt(2, steps(0, 180, 15), up_down));
  expect_same(of_ies(turn, left_right), of_ies(steps(90, 270, 15), left_right));
  expect_same(of_ies(turn, left_right), of_ldt(3, steps(-90, 90, 15), left_right));
  expect_same(of_ies(turn, left_right), of_ldt(0, steps(0, 345, 15), left_right));
  expect_same(of_ies({0}, kPlain), of_ldt(1, {0}, kPlain));
  const Candela sides = [](double plane, double angle) { return 1000.0 - 5.0 * std::abs(plane) - angle; };
  for (const int type : {2, 3})
    expect_same(parse_ies(ies(type, steps(-60, 60, 10), steps(-40, 40, 10), sides), "a.ies").intensity,
                parse_ies(ies(type, steps(0, 60, 10), steps(-40, 40, 10), sides), "a.ies").intensity);
}

TEST(Lamp, FactorsCountAsTheFilesEditionSays) {
  const auto largest = [](const std::string& first, const std::string& factors) {
    return parse_ies(ies(1, {0}, {0, 90}, kPlain, first, factors), "a.ies").intensity.largest_cd();
  };
  EXPECT_NEAR(largest("IESNA:LM-63-2002\n", "0.9 1 60"), 90.0, 1e-9);
  EXPECT_NEAR(largest("IES:LM-63-2019\n", "0.9 1.10000 60"), 90.0, 1e-9);  // in LM-63-2019, 1.1 is not a factor
  EXPECT_NEAR(largest("", "0.9 0.5 60"), 45.0, 1e-9);                      // LM-63-86
  const PhotometricLamp lamp = parse_ies(ies(1, {0}, {0, 90}, kPlain), "a.ies");
  EXPECT_EQ(lamp.printed_lumens, 1000.0);
  EXPECT_EQ(lamp.title, "A lamp");
  EXPECT_EQ(parse_ldt(ldt(1, 30, {0, 90}, kPlain, {0}), "a.ldt").printed_lumens, 1600.0);
  std::string tilted = ies(1, {0}, {0, 90}, kPlain);
  tilted.replace(tilted.find("TILT=NONE"), 9, "TILT=INCLUDE\n1\n2\n0 90\n1 0.8");
  EXPECT_EQ(parse_ies(tilted, "a.ies").intensity.largest_cd(), 100.0);
}

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

// In files of LM-63-86 and LM-63-91, intensities are multiplied by the ballast-lamp photometric factor. In later
// editions, this field of the file has another meaning and is ignored (I. Ashdown, Parsing the IESNA LM-63 photometric
// data file, 1998; ANSI/IES LM-63-19).
TEST(Lamp, EditionIsThatOfItsHeader) {
  constexpr double kFactor = 1.1;
  const std::vector<std::pair<std::string, double>> headers = {{"", kFactor},
                                                               {"A label", kFactor},
                                                               {"IES indoor report", kFactor},
                                                               {"IES 40 W luminaire", kFactor},
                                                               {"Tested as IESNA:LM-63-2002 asks", kFactor},
                                                               {"IESNA86", kFactor},
                                                               {"IESNA:LM-63-1986", kFactor},
                                                               {"IES LM-63-86", kFactor},
                                                               {"IESNA91", kFactor},
                                                               {"IESNA:LM-63-1991", kFactor},
                                                               {"IESNA1991", kFactor},
                                                               {"IESNA95", 1.0},
                                                               {"IESNA:LM-63-1995", 1.0},
                                                               {"IESNA: LM-63-1995", 1.0},
                                                               {"IESNA LM63-95", 1.0},
                                                               {"IESNA:LM-63-2002", 1.0},
                                                               {"ANSI/IESNA LM-63-02", 1.0},
                                                               {"LM-63-2002", 1.0},
                                                               {"IES:LM-63-2019", 1.0},
                                                               {"IES LM 63-19", 1.0},
                                                               {"ANSI/IES LM-63-19", 1.0}};
  const std::string rest = ies(1, {0}, {0, 90}, kPlain, "", "0.9 1.1 60");
  for (const auto& [header, factor] : headers)
    for (const std::string& written : {header, lower_case(header), upper_case(header)})
      for (const std::string before : {"", "\xef\xbb\xbf", "\n", "\xef\xbb\xbf\r\n  \r\n", "[TEST] 1\n", "  \t"})
        for (const bool is_small : {false, true}) {
          const std::string text = before + written + " \r\n" + (is_small ? lower_case(rest) : rest);
          SCOPED_TRACE(text);
          const PhotometricLamp lamp = parse_ies(text, "a.ies");
          EXPECT_NEAR(lamp.intensity.largest_cd(), 90.0 * factor, 1e-9);
          EXPECT_EQ(lower_case(lamp.title), "a lamp");
        }
  for (const std::string header : {"IESNA:LM-63", "IES:LM-63-YEAR", "IESNA:LM-63-20022"})
    EXPECT_EQ(refusal_of([&] { parse_ies("\n" + header + "\n" + rest, "a.ies"); }), "a.ies:2: header");
  for (const std::string tilt : {"tilt=none", "TILT = NONE", "  Tilt=None  "})
    EXPECT_NEAR(parse_ies(with_replaced(rest, "TILT=NONE", tilt), "a.ies").intensity.largest_cd(), 99.0, 1e-9);
}

TEST(Lamp, ByteOrderMarkOfEulumdatIsNoText) {
  const std::string text = ldt(1, 30, {0, 90}, kPlain, {0});
  expect_same(parse_ldt(text, "a.ldt").intensity, parse_ldt("\xef\xbb\xbf" + text, "a.ldt").intensity);
}

TEST(Lamp, CutOffIsSeenOnTheRoad) {
  RoadScene scene;
  scene.lamp = read_lamp(std::string(RETRACE_SOURCE_DIR) + "/examples/low_beam.ies", {"lamp"});
  const LuminousIntensity& beam = scene.lamp->intensity;
  const auto ahead = [&](double right_deg, double up_deg) {
    return beam.cd(Vec3(std::tan(right_deg * kRadPerDeg), std::tan(up_deg * kRadPerDeg), -1.0));
  };
  EXPECT_GT(ahead(-2, -0.9), 30.0 * ahead(-2, -0.2));  // cut-off on the side of oncoming traffic
  EXPECT_GT(ahead(4, 0.2), 10.0 * ahead(-4, 0.2));     // on the other side, the cut-off is higher
  // The scene shows the rear of a car at 30 m. The lower part is illuminated and the upper part is dark, until the
  // lamps are aimed higher.
  const auto picture = [&](double aim_deg) {
    scene.lamp_aim_deg = aim_deg;
    RoadView view;
    view.distance_m = 30.0;
    view.reflectors.resize(2);
    draw_road(scene, view);
    return view.picture.luminance;
  };
  const auto sum = [](const std::vector<double>& values) {
    double total = 0.0;
    for (const double value : values) total += value;
    return total;
  };
  const std::vector<double> dipped = picture(0.0);
  const std::vector<double> raised = picture(-3.0);
  // The horizon is at 0.42 of the rows. The roof of the car is just above the horizon.
  const std::size_t roof =
      static_cast<std::size_t>(0.415 * static_cast<double>(scene.rows)) * scene.columns + scene.columns / 2;
  EXPECT_GT(raised[roof], 5.0 * dipped[roof]);
  EXPECT_GT(sum(dipped), 0.0);
}

std::string complaint(const std::string& text, bool is_ies = true) {
  return refusal_of([&] { is_ies ? parse_ies(text, "a.ies") : parse_ldt(text, "a.ldt"); });
}

TEST(Lamp, WhatIsWrongIsToldWithItsLine) {
  EXPECT_EQ(complaint(""), "a.ies:1");
  EXPECT_EQ(complaint("IESNA:LM-63-2002\nTILT=lamp.tlt\n"), "a.ies:2: TILT");
  const std::string right = ies(1, {0}, {0, 90}, kPlain);
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(complaint(with(right, "1 1000 2 2 1 1", "1 1000 2 2 1 4")), "a.ies:4: photometric type");
  EXPECT_EQ(complaint(with(right, "1 1000 2 2", "1 1000 2 2.5")), "a.ies:4: number of vertical angles");
  EXPECT_EQ(complaint(with(right, "1 1000 2 2", "1 1000 2 1e9")), "a.ies:4: number of vertical angles");
  EXPECT_EQ(complaint(with(right, "0 90", "90 0")), "a.ies:6: vertical angles");
  EXPECT_EQ(complaint(with(right, "50 50", "50 -50")), "a.ies:8: candela");
  EXPECT_EQ(complaint(with(right, "50 50", "50 nan")), "a.ies:8: candela");
  EXPECT_EQ(complaint(with(right, "50 50 \n", "50\n")), "a.ies:9");
  EXPECT_EQ(complaint(ies(1, {0, 100}, {0, 90}, kPlain)), "a.ies:9: horizontal angles");
  EXPECT_EQ(complaint(ies(3, {10, 40}, {0, 90}, kPlain)), "a.ies:9: horizontal angles");
  const std::string other = ldt(0, 30, {0, 90}, kPlain, steps(0, 330, 30));
  EXPECT_EQ(complaint("", false), "a.ldt:1");
  EXPECT_EQ(complaint(with(other, "1\n0\n12\n", "1\n5\n12\n"), false), "a.ldt:3: symmetry indicator");
  EXPECT_EQ(complaint(with(other, "1\n0\n12\n", "1\n4\n13\n"), false), "a.ldt:55: C planes");
  EXPECT_EQ(complaint(other.substr(0, other.size() / 2), false), "a.ldt:39: direct ratio");
  EXPECT_EQ(refusal_of([] { read_lamp("lamp.txt", {"lamp"}); }), "lamp");
}

}  // namespace
}  // namespace retrace::studies::lamp_test
