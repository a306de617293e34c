"""Compares the checked-in engine of the live page with the native engine. The answers of data/live_page/engine.* under
Node.js and in Chromium must match the answers of retrace_live, which is built from the same sources.

    python3 bundle_test.py SOURCE RETRACE_LIVE
"""

import base64
import gzip
import hashlib
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report" / "page"))
from browser import browser  # noqa: E402

SOURCE = NATIVE = None

# Tolerances of fractions of power, and of lengths in mm. Results differ in the last digit because the native engine and
# the browser use different libraries of mathematical functions.
SAME = 1e-11
SAME_MM = 1e-9
# Absorption limits the number of beams, so that all beams can be traced to their end. Without absorption, a difference
# in the last digit may change which beams are truncated.
ABSORBING = {"body.absorption_per_mm": 3}
NEARLY_ALL = 1e-11

DESIGNS = {
    "prisms": ("rtp", {}),
    "cubes": ("hexagonal_icc", {}),
    "triangles": ("triangular_icc", {}),
    "aluminium": ("hexagonal_icc", {"coating.facets": [{"material": "aluminium"}], "surface.dihedral_error_arcmin": 3}),
    "canted": ("hexagonal_icc", {"element.cant_deg": 4, "element.cant_azimuth_deg": 20, "body.material": "PC"}),
    "rounded": ("rtp", {"array.arrangement": "checker", "surface.rim_radius_um": 20, "surface.edge_chords": 4}),
    "polarised": ("rtp", {"body.back_index": 1.2, "light.polarisation": "linear"}),
}
FINITE = """[element]
kind = "hexagonal_icc"
aperture_mm = 1
[array]
x_length_mm = 2.2
y_length_mm = 2
[body]
thickness_mm = 1
absorption_per_mm = 3
[light]
spectrum = [[486.1, 1], [587.6, 2], [656.3, 1]]
[detector]
acceptance_half_angle_deg = [0.5, 5]
"""


def efficiency_at(footprint, at):
    """Returns the efficiency of the region that contains a position, or 0 outside all regions."""
    for region in footprint["regions"]:
        corners = list(zip(region["outline"][::2], region["outline"][1::2]))
        if all((x2 - x1) * (at[1] - y1) >= (y2 - y1) * (at[0] - x1)
               for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1])):
            return region["efficiency"]
    return 0.0


class Answers:
    """Engine that runs as a child process and answers line by line."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def text(self, request):
        self.process.stdin.write(request + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().rstrip("\n")

    def ask(self, **request):
        return json.loads(self.text(json.dumps(request)))

    def close(self):
        self.process.communicate()


class InChromium:
    """Engine that runs in a browser."""

    START = """
    const [packed, done] = arguments;
    const stream = new Blob([Uint8Array.from(atob(packed), (c) => c.charCodeAt(0))]).stream();
    new Response(stream.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer().then(retraceEngine).then((call) => {
      window.call = call;
      done();
    });
    """

    def __init__(self, folder):
        self.scratch = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        page = pathlib.Path(self.scratch.name, "page.html")
        page.write_text(f"<!DOCTYPE html><script>{(folder / 'engine.js').read_text()}</script>")
        self.driver = browser(pathlib.Path(self.scratch.name, "profile"))
        self.driver.set_script_timeout(60)
        self.driver.get(page.as_uri())
        self.driver.execute_async_script(self.START, base64.b64encode((folder / "engine.wasm.gz").read_bytes()).decode())

    def text(self, request):
        return self.driver.execute_script("return call(arguments[0])", request)

    def close(self):
        self.driver.quit()
        self.scratch.cleanup()


class Bundle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = SOURCE / "data/live_page"
        cls.native = Answers(NATIVE)
        cls.addClassCleanup(cls.native.close)
        cls.bundle = Answers("node", SOURCE / "tests/live/bundle.cjs", folder)
        cls.addClassCleanup(cls.bundle.close)
        cls.chromium = InChromium(folder)
        cls.addClassCleanup(cls.chromium.close)

    def same(self, a, b, where=""):
        """Expects equal JSON values. Numbers may differ within the tolerances."""
        if isinstance(a, bool) or not isinstance(a, (int, float, list, dict)):
            self.assertEqual(a, b, where)
        elif isinstance(a, dict):
            self.assertEqual(list(a), list(b), where)
            for key in a:
                self.same(a[key], b[key], f"{where}.{key}")
        elif isinstance(a, list):
            self.assertEqual(len(a), len(b), where)
            for k, (x, y) in enumerate(zip(a, b)):
                self.same(x, y, f"{where}[{k}]")
        else:
            is_length = any(word in where for word in ("outline", "points", "_mm", "vertices", "rims", "roots"))
            self.assertAlmostEqual(a, b, delta=(SAME_MM if is_length else SAME) * max(1.0, abs(a)), msg=where)

    def both(self, **request):
        """Expects equal answers of all engines and returns the answer. The answers in the browser and under Node.js
        must have the same bytes."""
        text = json.dumps(request)
        told = self.bundle.text(text)
        self.assertEqual(self.chromium.text(text), told)
        native = self.native.ask(**request)
        self.same(native, json.loads(told), request["ask"])
        self.assertTrue(native["ok"], native)
        return native

    def opened(self, name):
        if name == "finite":
            return self.both(ask="open", toml=FINITE, source="design.toml")["design"]
        kind, changes = DESIGNS[name]
        toml = self.both(ask="template", kind=kind, extent="infinite")["toml"]
        plain = self.both(ask="open", toml=toml, source="design.toml")["design"]
        return self.both(ask="set", design=plain, changes={**ABSORBING, **changes}, adapt=True)["design"]

    def test_files_are_of_one_build(self):
        folder = SOURCE / "data/live_page"
        packed = (folder / "engine.wasm.gz").read_bytes()
        script = (folder / "engine.js").read_text()
        self.assertIn(hashlib.sha256(packed).hexdigest(), script[:200])
        self.assertNotIn("</script", script)
        self.assertTrue(gzip.decompress(packed).startswith(b"\0asm"))
        other = sum((folder / name).stat().st_size for name in ("page.css", "page.html", "page.js"))
        self.assertLess(len(packed) * 4 / 3 + len(script) + other, 2.9e6, "a page is to stay below 3 MB")

    def test_two_hundred_points_ledgers_and_footprints(self):
        points = 0
        for name in (*DESIGNS, "finite"):
            with self.subTest(name):
                design = self.opened(name)
                exactly = {"design": design, "target_error": NEARLY_ALL, "engine": "exact"}
                directions = [[3.7 * k - 40.1, 17.3 * k] for k in range(28 if name != "finite" else 4)]
                points += len(self.both(ask="rre", directions=directions, **exactly)["points"])
                for incidence, azimuth in ((0, 0), (14.5, 21.0), (-31.0, 77.0)):
                    light = {"incidence_deg": incidence, "azimuth_deg": azimuth}
                    self.same_direction(ask="direction", **light, **exactly)
                    self.both(ask="path", at_mm=[0.31, 0.17], design=design, **light)
        self.assertEqual(points, 200)

    def same_direction(self, **request):
        """Expects equal light for one direction. Footprints are compared at random points, because their division into
        convex regions depends on rounding where edges meet."""
        native, bundle = (engine.ask(**request) for engine in (self.native, self.bundle))
        footprints = [answer.pop("footprint") for answer in (native, bundle)]
        spots = [answer["far_field"].pop("spots") for answer in (native, bundle)]
        for answer in (native, bundle):
            answer.pop("beams")
        self.same(native, bundle, "direction")
        self.assertAlmostEqual(sum(native["ledger"]), 1.0, delta=1e-9)
        self.same(*([spot["power"] for spot in of[:6]] for of in spots), "spots")
        for key in ("active_fraction", "shown"):
            self.assertAlmostEqual(*(footprint[key] for footprint in footprints), delta=SAME_MM, msg=key)
        chance = random.Random(1)
        corners = [of["outline"][k::2] for of in footprints[0]["regions"] for k in (0, 1)] or [[0]]
        low, high = min(map(min, corners)), max(map(max, corners))
        for at in ((chance.uniform(low, high), chance.uniform(low, high)) for _ in range(100)):
            self.assertAlmostEqual(*(efficiency_at(footprint, at) for footprint in footprints), delta=SAME_MM, msg=f"at {at}")

    def test_resampled_beams_agree_within_their_errors(self):
        for kind in ("rtp", "hexagonal_icc", "triangular_icc"):
            toml = self.both(ask="template", kind=kind, extent="infinite")["toml"]
            design = self.both(ask="open", toml=toml, source="design.toml")["design"]
            asked = {"ask": "rre", "design": design, "directions": [[12, 30], [25, 4]], "target_error": 1e-3}
            for a, b in zip(self.native.ask(**asked)["points"], self.bundle.ask(**asked)["points"]):
                self.assertAlmostEqual(a[0], b[0], delta=5 * math.hypot(a[2], b[2]) + a[1] + b[1])

    def test_forms_and_parts(self):
        self.both(ask="form")
        self.both(ask="about")
        self.both(ask="standards")
        self.both(ask="part", design=self.opened("prisms"))
        for name in ("cubes", "triangles"):
            self.assertGreater(len(self.both(ask="stl", design=self.opened(name))["base64"]), 500)

    def test_errors_are_the_programs_own(self):
        request = {"ask": "open", "toml": '[element]\nkind = "rtp"\nbase_mm = -3\n', "source": "design.toml"}
        for engine in (self.native, self.bundle):
            answer = engine.ask(**request)
            self.assertEqual(answer["text"], "design.toml:3: element.base_mm: must be > 0, got -3")
            self.assertEqual(engine.ask(ask="nonsense")["kind"], "input")

    def test_says_what_a_browser_has_not(self):
        for toml in ('[element]\nkind = "rtp"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 9\ny_length_mm = 9\n[body]\n'
                     'thickness_mm = 9\n[substrate]\nkind = "formula"\nsag_mm = "x^2"\n', ):
            answer = self.bundle.ask(ask="open", toml=toml, source="design.toml")
            self.assertFalse(answer["ok"])


if __name__ == "__main__":
    SOURCE, NATIVE = pathlib.Path(sys.argv[1]), sys.argv[2]
    unittest.main(argv=sys.argv[:1])
