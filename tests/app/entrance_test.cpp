// Tests of curved entrance surfaces with the program: turned parts and meshes in front of plates and prisms,
// commands that refuse a curved entrance surface, and invalid files.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "tests/app/program.h"

namespace retrace::test::front_test {
namespace {

const std::string kTool = "[tool]\nnose_radius_mm = 0.05\nclearance_deg = 40\n";
const std::string kBody = "[body]\nthickness_mm = 1.2\nrefractive_index = 1.4917\n";
const std::string kPlate = "[part]\nplate_mm = [1, 0.8]\n";
const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.25\nwidth_mm = 0.2\n[array]\nx_length_mm = 1\ny_length_mm = 0.8\n";
const std::string kFront = "[entrance_surface]\nturned_part = \"lens.toml\"\n";

std::string turned(const std::string& base, const std::string& more = {}, double radius_mm = 0.7,
                   const std::string& path = "feed_um = 10\nspindle_rpm = 60\n") {
  return "schema = \"retrace.turned_part/1\"\n[base]\n" + base + more + kTool +
         "[path]\nradius_mm = " + std::to_string(radius_mm) + "\n" + path;
}

const std::string kFlat = "kind = \"plane\"\n";
const std::string kCap = "kind = \"conic\"\nradius_mm = -3\n";

class Entrance : public ::testing::Test {
 protected:
  TemporaryFolder folder_;

  Json rre(const std::string& design, Arguments more) {
    folder_.write("design.toml", design);
    Arguments all = {"rre", "design.toml"};
    all.insert(all.end(), more.begin(), more.end());
    return retrace_json(folder_, all);
  }

  /// Returns the position `file:line: key` of the error for which a design is refused.
  std::string refusal(const std::string& design, Arguments command = {"rre", "design.toml", "-o", "out"}) {
    folder_.write("design.toml", design);
    const auto before = folder_.names();
    const Outcome outcome = retrace(folder_, command);
    EXPECT_EQ(folder_.names(), before);
    return refused_at(outcome);
  }
};

double total(const Json& point) {
  double sum = 0.0;
  for (const auto& [account, power] : point["ledger"].items()) sum += power.get<double>();
  return sum;
}

TEST_F(Entrance, FlatTurnedFrontIsThePlaneEntranceFace) {
  folder_.write("lens.toml", turned(kFlat));
  const std::string light = "[light]\npolarisation = \"right_circular\"\n";
  for (const std::string& back : {kPlate, kPrisms}) {
    const Arguments how = {"--engine", "embree", "--samples", "4096", "--incidence=0,25", "--azimuth=20"};
    const Json plane = rre(back + kBody + light, how);
    const Json front = rre(back + kFront + kBody + light, how);
    EXPECT_EQ(front["engine"], "embree");
    for (std::size_t k = 0; k < 2; ++k)
      for (const auto& [account, power] : plane["points"][k]["ledger"].items())
        EXPECT_NEAR(front["points"][k]["ledger"][account].get<double>(), power.get<double>(), 1e-9) << account;
  }
}

// Automatic differentiation of r = sqrt(x^2 + y^2) fails at the centre of the formula -r^2 / 6, where the sampling grid
// has a point. The conic describes the same paraboloid and must give the same result.
TEST_F(Entrance, FormulaOfTheRadiusIsItsConic) {
  const std::string body = kBody + "[detector]\nacceptance_half_angle_deg = 10\n[idealisation]\nfacets = \"mirror\"\n";
  const Arguments how = {"--samples", "2048", "--incidence=0,5"};
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -3\nconic = -1\n"));
  const Json conic = rre(kPlate + kFront + body, how);
  folder_.write("lens.toml", turned("kind = \"formula\"\nformula = \"-r^2/6\"\n"));
  const Json formula = rre(kPlate + kFront + body, how);
  for (std::size_t k = 0; k < 2; ++k)
    for (const auto& [account, power] : conic["points"][k]["ledger"].items())
      EXPECT_NEAR(formula["points"][k]["ledger"][account].get<double>(), power.get<double>(), 1e-9) << account;
}

// A surface that is given by `kind` must give the same results as a turned part with this surface, because the rays use
// the same random numbers.
TEST_F(Entrance, KindIsTheTurnedPartOfTheSameSurface) {
  const std::string prisms =
      "[element]\nkind = \"rtp\"\nbase_mm = 0.25\nwidth_mm = 0.2\n[array]\nx_length_mm = 1\ny_length_mm = 0.8\n";
  const std::string formula = "0.02*cos(5*x)*sin(4*y) - (x^2 + 2*y^2)/9";
  const std::pair<std::string, std::string> pairs[] = {
      {kCap, "kind = \"sphere\"\nradius_mm = 3\n"},
      {"kind = \"conic\"\nradius_mm = 2\nconic = -0.7\n", "kind = \"sphere\"\nradius_mm = -2\nconic = -0.7\n"},
      {"kind = \"formula\"\nformula = \"sqrt(4 - x^2) - 2\"\n", "kind = \"cylinder\"\nradius_mm = 2\n"},
      {"kind = \"formula\"\nformula = \"sqrt(4 - y^2) - 2\"\n",
       "kind = \"cylinder\"\nradius_mm = 2\nrotation_deg = 90\n"},
      {"kind = \"formula\"\nformula = \"-(x^2/3 + y^2/4)/(1 + sqrt(1 - x^2/9 - y^2/16))\"\n",
       "kind = \"biconic\"\nradii_mm = [3, 4]\n"},
      {"kind = \"formula\"\nformula = \"" + formula + "\"\n", "kind = \"formula\"\nformula = \"" + formula + "\"\n"}};
  const Arguments how = {"--samples", "4096", "--incidence=0,25", "--azimuth=20"};
  for (const auto& [base, kind] : pairs) {
    folder_.write("lens.toml", turned(base));
    const Json file = rre(prisms + kFront + kBody, how);
    const Json keys = rre(prisms + "[entrance_surface]\n" + kind + kBody, how);
    for (std::size_t k = 0; k < 2; ++k)
      for (const auto& [account, power] : file["points"][k]["ledger"].items())
        EXPECT_NEAR(keys["points"][k]["ledger"][account].get<double>(), power.get<double>(), 1e-6) << kind << account;
  }
}

TEST_F(Entrance, InspectDescribesASurfaceByItsKind) {
  folder_.write("design.toml", kPlate + "[entrance_surface]\nkind = \"sphere\"\nradius_mm = 3\n" + kBody);
  const Outcome outcome = retrace(folder_, {"inspect", "design.toml", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("entrance surface    sphere, z = "), std::string::npos) << outcome.out;
  const Json json = folder_.json("out/inspect.json");
  EXPECT_NEAR(json["entrance_surface"]["highest_mm"].get<double>(), 1.2, 1e-12);
  EXPECT_NEAR(json["entrance_surface"]["lowest_mm"].get<double>(), 1.2 - 3.0 + std::sqrt(9.0 - 0.25 - 0.16), 1e-12);
  EXPECT_EQ(json["design"]["entrance_surface"]["radius_mm"], 3.0);
}

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns a + s b.
Vector along(const Vector& a, double s, const Vector& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

Vector refracted(const Vector& d, const Vector& n, double ratio) {
  const double c = -dot(d, n);
  return along({ratio * d[0], ratio * d[1], ratio * d[2]}, ratio * c - std::sqrt(1.0 - ratio * ratio * (1.0 - c * c)),
               n);
}

/// Returns the angle, in degrees, between the returned light and the direction to the source. The light enters a
/// spherical cap in front of a mirror along -z, at (x, y) from the vertex. The cap is 1 mm by 0.8 mm.
double miss_deg(double radius, double thickness, double n, double x, double y) {
  const double r = std::abs(radius);
  const Vector in = {x, y, thickness - r + std::sqrt(r * r - x * x - y * y)};
  const auto normal = [&](const Vector& p) { return Vector{p[0] / r, p[1] / r, (p[2] - thickness + r) / r}; };
  Vector d = refracted({0.0, 0.0, -1.0}, normal(in), 1.0 / n);
  const Vector foot = along(in, -in[2] / d[2], d);
  d[2] = -d[2];
  const Vector q = {foot[0], foot[1], foot[2] - thickness + r};
  const double b = dot(q, d);
  const Vector out = along(foot, -b + std::sqrt(b * b - dot(q, q) + r * r), d);
  const Vector m = normal(out);
  if (std::abs(out[0]) > 0.5 || std::abs(out[1]) > 0.4) return 180.0;  // light that leaves through a side
  d = refracted(d, {-m[0], -m[1], -m[2]}, n);
  return std::acos(std::min(1.0, d[2])) * 180.0 / std::numbers::pi;
}

// The fraction of light that a cap in front of a mirror returns within a cone must agree with rays that the test traces
// itself.
TEST_F(Entrance, CapOverAMirrorReturnsWhatRaysByHandReturn) {
  folder_.write("lens.toml", turned(kCap));
  const double n = 1.4917;
  const double focus = n / (n - 1.0) * 3.0;
  for (const double thickness : {focus, 0.985 * focus}) {
    const double cone_deg = 0.04;
    constexpr int kCells = 1000;
    int kept = 0;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i)
        if (miss_deg(3.0, thickness, n, (i + 0.5) / kCells - 0.5, 0.8 * ((j + 0.5) / kCells - 0.5)) <= cone_deg) ++kept;
    const double share = static_cast<double>(kept) / (kCells * kCells);
    EXPECT_GT(share, 0.05);
    EXPECT_LT(share, 0.95);
    const Json json =
        rre(kPlate + kFront + "[body]\nrefractive_index = 1.4917\nthickness_mm = " + std::to_string(thickness) +
                "\n[detector]\nacceptance_half_angle_deg = " + std::to_string(cone_deg) +
                "\n[idealisation]\nfacets = \"mirror\"\nentrance = \"lossless\"\n",
            {"--samples", "32768"});
    EXPECT_NEAR(json["points"][0]["rre"].get<double>(), share, 1.5e-3) << thickness;
    EXPECT_NEAR(total(json["points"][0]), 1.0, 1e-9);
  }
}

// The mesh of the machined surface that `retrace turn` writes must act as the design, except for the effects of its
// cusps and of the finite size of its triangles.
TEST_F(Entrance, MachinedMeshActsAsTheDesign) {
  folder_.write("lens.toml", turned(kCap, {}, 0.7, "feed_um = 4\nspindle_rpm = 60\npoints_per_turn = 720\n") +
                                 "[inspect]\nmesh_thickness_mm = 0.3\nmesh_rings = 100\n");
  ASSERT_EQ(retrace(folder_, {"turn", "lens.toml", "-o", "out"}).code, 0);
  const std::string body =
      "[body]\nthickness_mm = 8\nrefractive_index = 1.4917\n[detector]\nacceptance_half_angle_deg = 2\n"
      "[idealisation]\nfacets = \"mirror\"\n";
  const Arguments how = {"--samples", "16384", "--incidence=0,1"};
  const Json exact = rre(kPlate + kFront + body, how);
  const Json mesh =
      rre(kPlate + "[entrance_surface]\nmesh = \"out/machined.stl\"\nmesh_side = \"bottom\"\n" + body, how);
  for (std::size_t k = 0; k < 2; ++k) {
    const Json& a = exact["points"][k];
    const Json& b = mesh["points"][k];
    const double error = std::hypot(a["std_error"].get<double>(), b["std_error"].get<double>());
    EXPECT_GT(a["rre"].get<double>(), 0.2);
    EXPECT_NEAR(a["rre"].get<double>(), b["rre"].get<double>(), 4.0 * error + 2e-3) << k;
    EXPECT_NEAR(total(b), 1.0, 1e-9);
    EXPECT_LT(b["ledger"]["lost"].get<double>(), 1e-9);
  }
}

// The example has lenslets in a hexagonal lattice on a square. A rotation by 180 degrees does not change the part. Each
// lenslet acts as a cat's eye.
TEST_F(Entrance, LensletsAreACatsEye) {
  const Json json = retrace_json(folder_, {"rre", example("fronts/cats_eye_lenslets.toml"), "--samples", "16384",
                                           "--incidence=0,2", "--azimuth=40,220", "--set", "body.absorption_per_mm=0"});
  EXPECT_EQ(json["engine"], "embree");
  EXPECT_EQ(json["designs"][0]["entrance_surface"]["turned_part"], "../turning/cats_eye_lenslets.toml");
  for (const Json& point : json["points"]) {
    EXPECT_NEAR(total(point), 1.0, 1e-9);
    EXPECT_EQ(point["ledger"]["lost"], 0.0);
  }
  // The points are ordered by azimuth, incidence and cone. Compare two points with the cone of 1 degree.
  const Json& one = json["points"][4];
  const Json& other = json["points"][10];
  EXPECT_EQ(one["incidence_deg"], 2.0);
  EXPECT_EQ(other["azimuth_deg"], 220.0);
  EXPECT_NEAR(one["rre"].get<double>(), other["rre"].get<double>(),
              5.0 * std::hypot(one["std_error"].get<double>(), other["std_error"].get<double>()));
  const Json defocused = retrace_json(folder_, {"rre", example("fronts/cats_eye_lenslets.toml"), "--samples", "16384",
                                                "--set", "body.thickness_mm=2.2"});
  EXPECT_GT(json["points"][1]["rre"].get<double>(), 2.0 * defocused["points"][1]["rre"].get<double>());
}

TEST_F(Entrance, InspectTellsAndDrawsIt) {
  folder_.write("lens.toml", turned(kCap));
  folder_.write("design.toml", kPlate + kFront + kBody);
  const Outcome outcome = retrace(folder_, {"inspect", "design.toml", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("entrance surface    lens.toml, z = "), std::string::npos) << outcome.out;
  const Json json = folder_.json("out/inspect.json");
  EXPECT_NEAR(json["entrance_surface"]["highest_mm"].get<double>(), 1.2, 1e-12);
  EXPECT_NEAR(json["entrance_surface"]["lowest_mm"].get<double>(), 1.2 - 3.0 + std::sqrt(9.0 - 0.25 - 0.16), 1e-12);
  const double steepest = std::asin(std::hypot(0.5, 0.4) / 3.0) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(json["entrance_surface"]["steepest_deg"].get<double>(), steepest, 1e-6);
  EXPECT_EQ(json["design"]["part"]["plate_mm"], Json::array({1.0, 0.8}));
  EXPECT_NE(folder_.read("out/entrance_surface.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(folder_.names(),
            (std::vector<std::string>{"design.toml", "lens.toml", "out", "out/entrance_surface.svg", "out/inspect.json",
                                      "out/plan.svg", "out/section.svg", "out/view.png"}));
  EXPECT_NE(folder_.read("out/plan.svg").find(">x length 1</text>"), std::string::npos);
}

TEST_F(Entrance, ReportShowsIt) {
  folder_.write("lens.toml", turned(kCap));
  rre(kPrisms + kFront + kBody, {"--samples", "64", "-o", "out"});
  const Outcome outcome = retrace(folder_, {"report", "out", "--read", "lens.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(warnings_of(outcome).empty()) << outcome.err;
}

// No light is lost in a plate with prisms behind the freeform lenslets of an example of `retrace turn`. The lenslets
// have steep blends.
TEST_F(Entrance, FreeformLensletsOverPrismsKeepAllLight) {
  const Json json =
      rre("[element]\nkind = \"rtp\"\nbase_mm = 0.05\nwidth_mm = 0.05\n[array]\nx_length_mm = 0.5\ny_length_mm = 0.4\n"
          "[entrance_surface]\nturned_part = \"" +
              example("turning/lenslet_array.toml") +
              "\"\n[body]\nthickness_mm = 0.1\nrefractive_index = 1.4917\nabsorption_per_mm = 0.1\n",
          {"--samples", "8192", "--incidence=0,30,70", "--azimuth=25"});
  for (const Json& point : json["points"]) {
    EXPECT_NEAR(total(point), 1.0, 1e-9);
    EXPECT_EQ(point["ledger"]["lost"], 0.0);
    EXPECT_GT(point["ledger"]["absorbed"].get<double>(), 0.001);
    EXPECT_GT(point["ledger"]["front_specular"].get<double>(), 0.01);
  }
}

TEST_F(Entrance, PhotometryTakesIt) {
  folder_.write("lens.toml", turned(kFlat));
  const Arguments plain = {"photometry", "design.toml", "--standard", "r150", "--class",    "IA",
                           "--colour",   "white",       "--area-cm2", "10",   "--json",     "-",
                           "--engine",   "montecarlo",  "--samples",  "8192", "--no-advice"};
  const std::string body = kBody + "facet_coating = \"aluminium\"\n";
  folder_.write("design.toml", kPlate + body);
  const Outcome plane = retrace(folder_, plain);
  folder_.write("design.toml", kPlate + kFront + body);
  const Outcome front = retrace(folder_, plain);
  ASSERT_LT(front.code, 2) << front.err;
  const Json a = Json::parse(plane.out);
  const Json b = Json::parse(front.out);
  ASSERT_EQ(a["points"].size(), b["points"].size());
  for (std::size_t k = 0; k < a["points"].size(); ++k) {
    const double value = a["points"][k]["value_mcd_per_lx"].get<double>();
    EXPECT_NEAR(b["points"][k]["value_mcd_per_lx"].get<double>(), value, 1e-9 * (1.0 + value)) << k;
  }
}

/// Returns a design with cube corners (aperture 3 mm) behind the turned surface `lens.toml`.
std::string cubes(double error_arcmin, const std::string& front = kFront) {
  return "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\narrangement = \"honeycomb\"\nx_length_mm = "
         "16\ny_length_mm = 12\n[surface]\ndihedral_error_arcmin = " +
         std::to_string(error_arcmin) + "\n[body]\nthickness_mm = 2.5\nrefractive_index = 1.4917\n" + front;
}

class CurvedPhotometry : public Entrance {
 protected:
  Json measure(const std::string& design, Arguments more, int code) {
    folder_.write("design.toml", design);
    folder_.write("limits.csv",
                  "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n"
                  "S,,white,0.2,0,0,1,cd/lx/m2,read\nS,,white,0.4,10,0,1,cd/lx/m2,read\n");
    Arguments all = {
        "photometry", "design.toml", "--standard=limits.csv", "--area-cm2=2", "--light=design", "--no-advice", "--json",
        "-"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder_, all);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    return Json::parse(outcome.out);
  }
};

TEST_F(CurvedPhotometry, HasAVerdictBehindALens) {
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -400\n", {}, 11.0));
  const Json json = measure(cubes(0.0), {}, 0);
  EXPECT_EQ(json["verdict"], "pass");
  EXPECT_EQ(json["engine"], "exact");
  EXPECT_EQ(json["diffraction"], true);
  const Json& model = json["entrance_model"];
  EXPECT_EQ(model["method"], "tangent_planes");
  EXPECT_GT(model["elements"].get<int>(), 20);
  EXPECT_LT(model["max_angle_arcmin"].get<double>(), model["allowed_angle_arcmin"].get<double>());
  EXPECT_NEAR(model["allowed_angle_arcmin"].get<double>(), 1.0, 1e-9);
  // The second point is dark. Its error is compared with the light of the first one.
  const double bright = json["points"][0]["value_mcd_per_lx"].get<double>();
  for (const Json& point : json["points"]) EXPECT_LT(point["std_error_mcd_per_lx"].get<double>(), 0.05 * bright);
}

// If the discs of source and receiver are wide, diffraction has little effect. Beams behind tangent planes then agree
// with rays through the surface.
TEST_F(CurvedPhotometry, AgreesWithRaysOverWideDiscs) {
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -300\n", {}, 11.0));
  const Arguments wide = {"--source-arcmin=60", "--receiver-arcmin=60", "--window-deg=3"};
  const Json beams = measure(cubes(1.0), wide, 0);
  Arguments by_rays = wide;
  by_rays.insert(by_rays.end(), {"--engine=montecarlo", "--samples=262144"});
  const Json rays = measure(cubes(1.0), by_rays, 1);  // undetermined without diffraction
  EXPECT_EQ(rays["engine"], "embree");
  for (std::size_t k = 0; k < 2; ++k) {
    const double value = rays["points"][k]["value_mcd_per_lx"].get<double>();
    const double error = rays["points"][k]["std_error_mcd_per_lx"].get<double>() +
                         beams["points"][k]["std_error_mcd_per_lx"].get<double>();
    EXPECT_NEAR(beams["points"][k]["value_mcd_per_lx"].get<double>(), value, 2.0 * error + 0.02 * value) << k;
    const double rre = rays["directions"][k]["rre"].get<double>();
    EXPECT_NEAR(beams["directions"][k]["rre"].get<double>(), rre, 0.02 * rre) << k;
  }
}

TEST_F(CurvedPhotometry, StaysUndeterminedWithoutTangentPlanes) {
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -400\n", {}, 11.0));
  const Arguments few = {"--samples=4096"};
  const Json plain = measure(cubes(0.0), {"--samples=4096", "--no-diffraction"}, 1);
  EXPECT_EQ(plain["verdict"], "undetermined");
  EXPECT_EQ(plain["engine"], "embree");
  EXPECT_FALSE(plain.contains("entrance_model"));
  // A strongly curved surface deviates too much from its tangent planes. Photometry then uses rays.
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -30\n", {}, 11.0));
  const Json strong = measure(cubes(0.0), few, 1);
  EXPECT_EQ(strong["verdict"], "undetermined");
  EXPECT_EQ(strong["engine"], "embree");
  EXPECT_FALSE(strong.contains("entrance_model"));
  folder_.write("lens.stl",
                "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 16 0 0\nvertex 16 12 0\nendloop\n"
                "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 16 12 0\nvertex 0 12 0\nendloop\n"
                "endfacet\nendsolid a\n");
  const Json mesh = measure(cubes(0.0, "[entrance_surface]\nmesh = \"lens.stl\"\ncentre_mm = [0, 0]\n"), few, 1);
  EXPECT_EQ(mesh["verdict"], "undetermined");
  EXPECT_EQ(mesh["engine"], "embree");
}

TEST_F(Entrance, OthersRefuseItByName) {
  folder_.write("lens.toml", turned(kFlat));
  const std::string design = kPrisms + kFront + kBody;
  const std::string where = "design.toml:9: entrance_surface.turned_part";
  EXPECT_EQ(refusal(design, {"rre", "design.toml", "--engine=exact"}), "--engine");
  EXPECT_EQ(refusal(design, {"rre", "design.toml", "--engine=cell"}), "--engine");
  for (const char* option : {"--footprint", "--far-field", "--derivatives"})
    EXPECT_EQ(refusal(design, {"rre", "design.toml", option, "-o", "out"}), where);
  EXPECT_EQ(refusal(design, {"image", "design.toml", "--detector", "--engine=exact", "-o", "out"}), where);
  EXPECT_EQ(refusal(design, {"image", "design.toml", "--camera", "--eye-mm=0.1,0.1,1.1", "-o", "out"}), "--eye-mm");
  EXPECT_EQ(refusal(design, {"export", "design.toml", "out.stl", "--what=element"}), where);
  EXPECT_EQ(refusal(design, {"export", "design.toml", "out.json"}), where);
  EXPECT_EQ(refusal(design, {"export", "design.toml", "out.stl", "--surface-error-mm=0"}), "--surface-error-mm");
  EXPECT_EQ(refusal(kPrisms + kBody, {"export", "design.toml", "out.stl", "--surface-error-mm=0.1"}),
            "--surface-error-mm");
  EXPECT_EQ(refusal(design, {"job", "design.toml", "--tool-width-mm=0.2", "-o", "job.toml"}), where);
  EXPECT_EQ(refusal(design, {"roughness", "design.toml", "-o", "out"}), where);
}

/// Closed surface that the test reads from a binary STL file.
struct ReadSolid {
  std::size_t triangles = 0;
  std::size_t open_edges = 0;  ///< edges that are not traversed one time in each direction
  double volume_mm3 = 0.0;
};

/// Reads a binary STL file without the reader of the program. Vertices with equal coordinates are treated as one
/// vertex.
ReadSolid read_binary_stl(const std::string& text) {
  using Corner = std::array<float, 3>;
  ReadSolid solid;
  std::uint32_t count = 0;
  std::memcpy(&count, text.data() + 80, 4);
  solid.triangles = count;
  EXPECT_EQ(text.size(), 84U + 50U * count);
  std::map<std::pair<Corner, Corner>, int> traversals;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<Corner, 3> corners;
    std::memcpy(corners.data(), text.data() + 84 + 50 * t + 12, 36);
    const auto& [a, b, c] = corners;
    const auto minor = [&](std::size_t i, std::size_t j) {
      return static_cast<double>(b[i]) * c[j] - static_cast<double>(b[j]) * c[i];
    };
    solid.volume_mm3 += (a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) ++traversals[{corners[k], corners[(k + 1) % 3]}];
  }
  for (const auto& [edge, times] : traversals)
    if (times != 1 || !traversals.contains({edge.second, edge.first})) ++solid.open_edges;
  return solid;
}

// The volume is the sum of two volumes: that of the prisms, and the integral of the height of the sphere over the
// rectangle.
TEST_F(Entrance, ExportsAreClosedSolids) {
  folder_.write("lens.toml", turned(kCap));
  folder_.write("design.toml", kPrisms + kFront + kBody);
  double below_sphere = 0.0;
  constexpr int kCells = 400;
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const double x = (i + 0.5) / kCells - 0.5;
      const double y = 0.8 * ((j + 0.5) / kCells - 0.5);
      below_sphere += 0.8 / (kCells * kCells) * (1.2 - 3.0 + std::sqrt(9.0 - x * x - y * y));
    }
  const double volume = below_sphere + 16.0 * 0.25 * 0.25 * 0.25 * 0.2;
  for (const double error_mm : {1e-3, 1e-4}) {
    const Json json =
        retrace_json(folder_, {"export", "design.toml", "solid.stl", "--surface-error-mm", std::to_string(error_mm)});
    EXPECT_TRUE(json["is_manifold"].get<bool>());
    EXPECT_LE(json["surface_error_mm"].get<double>(), error_mm);
    EXPECT_GT(json["surface_error_mm"].get<double>(), 0.05 * error_mm);
    EXPECT_NEAR(json["volume_mm3"].get<double>(), volume, 0.8 * error_mm);
    EXPECT_NEAR(json["upper_mm"][2].get<double>(), 1.2, error_mm);
    const ReadSolid solid = read_binary_stl(folder_.read("solid.stl"));
    EXPECT_EQ(solid.open_edges, 0U);
    EXPECT_EQ(solid.triangles, json["triangles"].get<std::size_t>());
    EXPECT_NEAR(solid.volume_mm3, json["volume_mm3"].get<double>(), 1e-6);
  }
  for (const std::string file : {"solid.obj", "solid.glb", "solid.step"})
    EXPECT_EQ(retrace(folder_, {"export", "design.toml", file}).code, 0) << file;
  // The mould fits the back, which the entrance surface does not change.
  const auto mould = [&] {
    return retrace_json(folder_, {"export", "design.toml", "--what=mould"})["volume_mm3"].get<double>();
  };
  const double behind = mould();
  folder_.write("design.toml", kPrisms + kBody);
  EXPECT_EQ(mould(), behind);
}

// An entrance surface that is given as a mesh is exported with its own triangles. The mesh is that of the machined
// surface, which `retrace turn` writes.
TEST_F(Entrance, MeshesAreExportedAsTheyAre) {
  folder_.write("lens.toml", turned(kCap, {}, 0.7, "feed_um = 4\nspindle_rpm = 60\npoints_per_turn = 720\n") +
                                 "[inspect]\nmesh_thickness_mm = 0.3\nmesh_rings = 100\n");
  ASSERT_EQ(retrace(folder_, {"turn", "lens.toml", "-o", "out"}).code, 0);
  folder_.write("design.toml",
                kPlate + "[entrance_surface]\nmesh = \"out/machined.stl\"\nmesh_side = \"bottom\"\n" + kBody);
  const Json json = retrace_json(folder_, {"export", "design.toml", "solid.stl"});
  EXPECT_TRUE(json["is_manifold"].get<bool>());
  EXPECT_EQ(json["surface_error_mm"].get<double>(), 0.0);
  const ReadSolid solid = read_binary_stl(folder_.read("solid.stl"));
  EXPECT_EQ(solid.open_edges, 0U);
  folder_.write("design.toml", kPlate + kFront + kBody);
  const Json exact = retrace_json(folder_, {"export", "design.toml"});
  EXPECT_NEAR(json["volume_mm3"].get<double>(), exact["volume_mm3"].get<double>(), 1e-3);
}

TEST_F(Entrance, ImagesOfAPlaneSurfaceAreThoseOfThePlaneFace) {
  folder_.write("lens.toml", turned(kFlat));
  folder_.write("plane.toml", kPrisms + kBody);
  folder_.write("front.toml", kPrisms + kFront + kBody);
  const auto picture = [&](const std::string& design, const std::string& seed) {
    return retrace_json(folder_, {"image", design, "--camera", "--no-diffraction", "--pixels=20x16", "--passes=24",
                                  "--ambient-lx=5", "--lamp-arcmin=60", "--h-deg=5", "--seed=" + seed});
  };
  const Json plane = picture("plane.toml", "1");
  const Json front = picture("front.toml", "2");
  EXPECT_EQ(front["engine"], "embree");
  EXPECT_FALSE(front["has_diffraction"].get<bool>());
  EXPECT_EQ(front["eye_mm"], plane["eye_mm"]);
  const double mean = plane["part_luminance_cd_per_m2"].get<double>();
  const double error =
      std::hypot(plane["part_std_error_cd_per_m2"].get<double>(), front["part_std_error_cd_per_m2"].get<double>());
  EXPECT_GT(mean, 0.0);
  EXPECT_NEAR(front["part_luminance_cd_per_m2"].get<double>(), mean, 4.5 * error);
  const auto map = [&](const std::string& design) {
    return retrace_json(folder_, {"image", design, "--detector", "--engine=montecarlo", "--pixels=20",
                                  "--samples=65536", "--incidence=10", "--azimuth=20"});
  };
  const Json maps = map("front.toml");
  EXPECT_NEAR(maps["rre"].get<double>(), map("plane.toml")["rre"].get<double>(), 1e-9);
  EXPECT_EQ(maps["engine"], "embree");
  const Json road = retrace_json(folder_, {"image", "front.toml", "--road", "--road-distance-m=30"});
  EXPECT_TRUE(road["complete"].get<bool>());
  EXPECT_GT(road["views"][0]["reflectors"][0]["r_a_cd_per_lx_m2"][0].get<double>(), 0.0);
}

TEST_F(Entrance, StudiesTakeIt) {
  folder_.write("lens.toml", turned(kCap));
  folder_.write("design.toml", kPrisms + kFront + kBody + "[light]\nwavelength_nm = 550\n");
  const std::string study =
      "design = \"design.toml\"\n[analysis]\nsamples = 2048\n[[parameter]]\nkey = \"body.thickness_mm\"\n"
      "values = [1.2, 1.5]\n[[quantity]]\nkind = \"lens_thickness_mm\"\n[[quantity]]\nkind = \"effective_area_mm2\"\n";
  folder_.write("study.toml", study + "[[quantity]]\nkind = \"rre\"\n");
  const Outcome outcome = retrace(folder_, {"sweep", "study.toml", "-o", "out"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string table = folder_.read("out/sweep.csv");
  EXPECT_NE(table.find("1.325"), std::string::npos) << table;  // depth of the prisms + height of the vertex
  EXPECT_NE(table.find("1.625"), std::string::npos) << table;
  folder_.write("study.toml", study + "[[quantity]]\nkind = \"tir_limit_deg\"\n");
  const Outcome failed = retrace(folder_, {"sweep", "study.toml", "-o", "other"});
  EXPECT_EQ(failed.code, 1);
  EXPECT_NE(failed.err.find("design.toml:9: entrance_surface.turned_part"), std::string::npos) << failed.err;
}

TEST_F(Entrance, FilesThatMakeNoSenseAreRefused) {
  const std::string design = kPlate + kFront + kBody;
  const std::string where = "design.toml:4: entrance_surface.turned_part";
  EXPECT_EQ(refusal(design), where);
  folder_.write("lens.toml", turned(kFlat, {}, 0.6));
  EXPECT_EQ(refusal(design), where);
  folder_.write("lens.toml", turned(kFlat, "[boundary]\nkind = \"circle\"\nradius_mm = 0.55\n"));
  EXPECT_EQ(refusal(design), where);
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = -0.9\n"));
  EXPECT_EQ(refusal(kPlate + kFront + "centre_mm = [0.45, 0.38]\n[body]\nthickness_mm = 0.2\n"), where);
  folder_.write("lens.toml", turned("kind = \"conic\"\nradius_mm = 0\n"));
  EXPECT_EQ(refusal(design), where);
  folder_.write("lens.toml", "solid\nendsolid\n");
  EXPECT_EQ(refusal(kPlate + "[entrance_surface]\nmesh = \"lens.toml\"\n" + kBody),
            "design.toml:4: entrance_surface.mesh");
}

TEST_F(Entrance, KeysThatMakeNoSenseAreRefused) {
  folder_.write("lens.toml", turned(kFlat));
  const std::string plate_body = kPlate + kBody;
  EXPECT_EQ(refusal(plate_body + "[entrance_surface]\n"), "design.toml:6: entrance_surface.turned_part");
  EXPECT_EQ(refusal(plate_body + kFront + "mesh = \"a.stl\"\n"), "design.toml:7: entrance_surface.turned_part");
  EXPECT_EQ(refusal(plate_body + kFront + "mesh_side = \"top\"\n"), "design.toml:8: entrance_surface.mesh_side");
  EXPECT_EQ(refusal(plate_body + "[entrance_surface]\nmesh = \"a.stl\"\nmesh_side = \"left\"\n"),
            "design.toml:8: entrance_surface.mesh_side");
  EXPECT_EQ(refusal(plate_body + kFront + "centre_mm = [1]\n"), "design.toml:8: entrance_surface.centre_mm");
  EXPECT_EQ(refusal("[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nextent = \"infinite\"\n" + kFront +
                    kBody),
            "design.toml:8: entrance_surface.turned_part");
  EXPECT_EQ(refusal("[element]\nkind = \"ball\"\ndiameter_mm = 1\n[body]\nrefractive_index = 1.9\n" + kFront),
            "design.toml:6: entrance_surface");
  EXPECT_EQ(refusal("[part]\nplate_mm = [1, 1, 1]\n" + kBody), "design.toml:2: part.plate_mm");
  EXPECT_EQ(refusal("[part]\nplate_mm = 1\n" + kBody), "design.toml:2: part.plate_mm");
  EXPECT_EQ(refusal("[part]\nplate_mm = [1, 1]\nmesh = \"a.stl\"\n" + kBody), "design.toml:3: part.mesh");
  EXPECT_EQ(refusal("[part]\nplate_mm = [1, 1]\n" + kBody + "[surface]\nfacet_tilt_arcmin = [1, 1]\n"),
            "design.toml:7: surface.facet_tilt_arcmin");
  EXPECT_EQ(refusal("[part]\nplate_mm = [1, 1]\n[element]\nkind = \"rtp\"\n" + kBody), "design.toml:3: element");
  EXPECT_EQ(refusal("[part]\nplate_mm = [1, 1]\n[body]\nrefractive_index = 1.5\n"), "design.toml:3: body.thickness_mm");
}

}  // namespace
}  // namespace retrace::test::front_test
