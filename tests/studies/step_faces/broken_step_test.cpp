// Tests of damaged STEP files. The program that reads them may crash or exhaust its limits, but each file leads to an
// error message of one line within the limits.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/io/reader_program.h"
#include "geometry/io/step_reader.h"
#include "tests/studies/step_faces/step_texts.h"
#include "tests/support/refusals.h"

namespace retrace::testing::broken_step_test {
namespace {

/// Python code that writes one damaged file for each entry of `broken`. `spline`, `sphere` and `box` are whole files.
constexpr const char* kBroken = R"py(
import re
def text(shape, solid=False):
    s = w.StepFile()
    shape(s)
    return s.text(solid)
def edited(text, pattern, replacement):
    result, count = re.subn(pattern, replacement, text, count=1)
    assert count == 1, pattern
    return result
def folded(s):
    knots = [(0, 4), (1, 4)]
    points = [[(x, y, -0.001 * x * x) for y in (-15, -5, 5, 15)] for x in (-20, 30, -30, 20)]
    w.face_over(s, s.spline_surface(points, knots, knots), w.plane_height((0, 0)), w.rectangle(w.LOW, w.HIGH))
def apart(s):
    for x in (0, 100):
        plane = s.plane((0, 0, 0), (0, 0, 1), (1, 0, 0))
        w.face_over(s, plane, w.plane_height((0, 0)), w.rectangle((x, 0), (x + 40, 30)))
spline, sphere = text(w.spline), text(w.sphere)
surface = re.search(r'#(\d+)=B_SPLINE_SURFACE', spline).group(1)
end = 'ENDSEC;\nEND-ISO'
broken = {
    'empty': '',
    'other_format': 'solid cube\nendsolid cube\n',
    'truncated': spline[:len(spline) // 2],
    'without_end': spline[:spline.index('END-ISO')],
    'without_faces': w.StepFile().text(),
    'without_unit': edited(spline, r'\(LENGTH_UNIT\(\)NAMED_UNIT\(\*\)SI_UNIT\(.MILLI.,.METRE.\)\)',
                           '(NAMED_UNIT(*)RATIO_UNIT())'),
    'unit_of_mass': edited(spline, r'\.MILLI\.,\.METRE\.', '$,.GRAM.'),
    'small_unit': edited(spline, r'\.MILLI\.', '.PICO.'),
    'large_unit': edited(spline, r'\.MILLI\.', '.TERA.'),
    'million_faces': w.StepFile().text().replace(
        end, ''.join(f"#{k}=ADVANCED_FACE('',(),#1,.T.);\n" for k in range(1000, 1001000)) + end),
    'folded': text(folded),
    'missing_surface': edited(spline, f',#{surface},.T.\\)', ',#999999,.T.)'),
    'wrong_surface': edited(spline, f',#{surface},.T.\\)', ',#1,.T.)'),
    'huge_coordinates': re.sub(r"CARTESIAN_POINT\('',\(-20.0,", "CARTESIAN_POINT('',(-2E300,", spline),
    'no_numbers': re.sub(r"CARTESIAN_POINT\('',\(-20.0,", "CARTESIAN_POINT('',(NaN,", spline),
    'knots_descend': edited(spline, r'\(-20.0,-4.0,20.0\)', '(-20.0,30.0,20.0)'),
    'wrong_multiplicity': edited(spline, r'\(4,1,4\)', '(4,9,4)'),
    'high_degree': edited(spline, r"WITH_KNOTS\('',3,3,\(\(", "WITH_KNOTS('',300,3,(("),
    'short_grid': edited(spline, r"(SURFACE_WITH_KNOTS\('',3,3,\()\([^)]*\),", r'\1'),
    'negative_radius': edited(sphere, r'(SPHERICAL_SURFACE.*),150.0\)', r'\1,-150.0)'),
    'radius_0': edited(sphere, r'(SPHERICAL_SURFACE.*),150.0\)', r'\1,0.0)'),
    'open_loop': edited(spline, r"(EDGE_LOOP\('',\()#\d+,", r'\1'),
    'refers_to_itself': spline.replace(f'#{surface}=', f"#{surface}=OFFSET_SURFACE('',#{surface},1.0,.F.);\n#77777="),
    'equal_points': re.sub(r"CARTESIAN_POINT\('',\([^)]*\)", "CARTESIAN_POINT('',(1.0,1.0,1.0)", spline),
    'noise': spline[:3000] + '\x00\xff\x13;;((\'' * 50 + spline[3200:],
    'equal_numbers': spline.replace('#20=', '#21=', 1),
    'apart': text(apart)
}
for name, content in broken.items():
    open(name + '.step', 'w', encoding='latin1').write(content)
open('names', 'w').write('\n'.join(broken))
open('spline.step', 'w').write(spline)
)py";

rusage usage_of_children() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return usage;
}

/// Returns the processor time of all children that have ended.
double seconds_of_children() {
  const rusage usage = usage_of_children();
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class BrokenStep : public ::testing::Test {
 protected:
  void SetUp() override { run_step_writer(folder_, kBroken); }
  std::string file(const std::string& name) const { return (folder_.path() / (name + ".step")).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(BrokenStep, IsRefusedInOneLineWithinTheLimits) {
  int count = 0;
  for (const std::string& name : test::lines_of(folder_.read("names"))) {
    const double before_s = seconds_of_children();
    const std::string face = name == "apart" ? "towards +z" : "largest";
    EXPECT_EQ(refusal_of([&] { geometry::read_step_surface({.file = file(name), .face = face}); }),
              "TMP/" + name + ".step");
    EXPECT_LT(seconds_of_children() - before_s, geometry::kMaxStepSeconds + 1.0) << name;
    ++count;
  }
  EXPECT_GE(count, 20);
  const rusage usage = usage_of_children();
  EXPECT_LT(static_cast<double>(usage.ru_maxrss) * 1024.0, static_cast<double>(geometry::kMaxStepMemoryBytes));
}

TEST_F(BrokenStep, FilesThatAreNoFilesAreRefused) {
  EXPECT_EQ(refusal_of([&] { geometry::read_step_surface({.file = file("missing")}); }), "TMP/missing.step");
  EXPECT_EQ(refusal_of([&] { geometry::read_step_surface({.file = folder_.path()}); }), "TMP");
}

// Random changes of a file lead to a surface or to an error of one line.
TEST_F(BrokenStep, RandomChangesAreReadOrRefused) {
  const std::string whole = folder_.read("spline.step");
  std::mt19937 random(7);
  const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
  int taken = 0;
  constexpr int kChanges = 40;
  for (int k = 0; k < kChanges; ++k) {
    std::string text = whole;
    const std::size_t data = text.find("DATA;") + 6;
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
      const std::size_t at = data + below(text.size() - data - 40);
      switch (below(4)) {
        case 0: text[at] = static_cast<char>(below(256)); break;
        case 1: text.erase(at, 1 + below(8)); break;
        case 2: text.insert(at, text.substr(data + below(text.size() - data - 40), 1 + below(12))); break;
        default:
          if (const std::size_t digit = text.find_first_of("0123456789", at); digit != std::string::npos)
            text[digit] = static_cast<char>('0' + below(10));
      }
    }
    const std::string name = "changed" + std::to_string(k);
    folder_.write(name + ".step", text);
    const std::string place =
        unrecorded_refusal_of([&] { geometry::read_step_surface({.file = file(name)}); }, "taken");
    if (place == "taken")
      ++taken;
    else
      EXPECT_EQ(place, "TMP/" + name + ".step");
  }
  EXPECT_GT(taken, 0);
  EXPECT_LT(taken, kChanges);
}

}  // namespace
}  // namespace retrace::testing::broken_step_test
