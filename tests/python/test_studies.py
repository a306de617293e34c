"""Tests of sweeps, tolerances, optima, surfaces, pictures and pages. Documents equal those of the
program. Functions that exist only in Python are also tested."""

import json
import os
import tempfile
import unittest

import numpy as np

import program
import retrace as rt

BEAM = program.example("low_beam.ies")
BRICK = program.example("rtp_brick_1mm.toml")
PRISM = program.example("rtp_single_0p45mm.toml")
# Some studies set a target error. A number of rays cannot be combined with it, so the target error
# is unset.
SOME_RAYS = {
    "analysis.engine": "montecarlo",
    "analysis.samples": 64,
    "analysis.target_error": None,
}
SET = [
    word
    for key, value in SOME_RAYS.items()
    for word in ("--set", f"{key}={'' if value is None else value}")
]


class Equality(unittest.TestCase):
    maxDiff = 2000

    def walk(self, command, call, least):
        answers = 0
        for file in program.files_of("retrace.study/1"):
            with self.subTest(file=os.path.basename(file)):
                expected = program.document(command, file, *SET)
                self.assertEqual(program.answer(call, file, changes=SOME_RAYS), expected)
                answers += expected[0] is not None
        self.assertGreaterEqual(answers, least)

    def test_sweep(self):
        self.walk("sweep", rt.sweep, least=7)

    def test_tolerance(self):
        self.walk("tolerance", rt.tolerance, least=2)

    def test_optimize(self):
        self.walk("optimize", rt.optimize, least=2)

    def test_metrology(self):
        for name in ("facet_height_map.txt", "edge_profile.txt"):
            file = program.example(name)
            for options, keywords in (
                ([], {}),
                (
                    ["--form=poly2", "--cutoff-um=50", "--feed-mm-per-min=10"],
                    {"form": "poly2", "cutoff_um": 50, "feed_mm_per_min": 10},
                ),
                (["--edge", "--pixel-um=0.5,0.5"], {"edge": True, "pixel_um": 0.5}),
            ):
                with self.subTest(file=name, keywords=keywords):
                    self.assertEqual(
                        program.answer(rt.metrology, file, **keywords),
                        program.document("metrology", file, *options),
                    )

    def test_image(self):
        small = {"samples": 1024, "engine": "montecarlo", "pixels": 30, "angle_pixels": 11}
        options = [
            "--detector",
            "--samples=1024",
            "--engine=montecarlo",
            "--pixels=30",
            "--angle-pixels=11",
        ]
        answers = 0
        # Usually every ninth design, because the pictures of some designs take a second.
        designs = program.some_designs(1)
        files = designs if program.IS_LONG_RUN else designs[::3]
        for file in files:
            with self.subTest(file=os.path.relpath(file, program.EXAMPLES)):
                expected = program.document("image", file, *options)
                self.assertEqual(program.answer(rt.image.detector, file, **small), expected)
                answers += expected[0] is not None
        self.assertGreaterEqual(answers, 15 if program.IS_LONG_RUN else 1)
        self.assertEqual(
            program.answer(
                rt.image.camera,
                BRICK,
                pixels=(24, 18),
                passes=2,
                ambient_lx=1,
                eye_mm=(0, 30, 8000),
                lamp=BEAM,
                lamp_aim_deg=1,
            ),
            program.document(
                "image",
                BRICK,
                "--camera",
                "--pixels=24x18",
                "--passes=2",
                "--ambient-lx=1",
                "--eye-mm=0,30,8000",
                f"--lamp={BEAM}",
                "--lamp-aim-deg=1",
            ),
        )
        red = rt.image.camera(BRICK, pixels=(24, 18), passes=2, v_deg=5, dye="red")["camera"]
        self.assertLessEqual({"X", "Y", "Z", "R", "G", "B"}, set(red))
        self.assertGreater(red["R"].mean(), 4 * abs(red["G"].mean()))
        small_camera = {"pixels": (16, 12), "passes": 2}
        series = rt.image.camera_series(BRICK, {"observation_deg": [0.2, 0.5]}, **small_camera)
        self.assertEqual(list(series.pictures), ["camera_01", "camera_02"])
        self.assertTrue(series.drawings["sheet"].png.startswith(b"\x89PNG"))
        one = rt.image.camera(BRICK, observation_deg=0.5, **small_camera)["camera"]
        np.testing.assert_array_equal(series["camera_02"]["Y"], one["Y"])
        self.assertEqual(
            program.answer(
                rt.image.camera_series, BRICK, {"observation_deg": [0.2, 0.5]}, **small_camera
            ),
            program.document(
                "image", BRICK, "--camera", "--pixels=16x12", "--passes=2", "--observation-deg=0.2,0.5"
            ),
        )
        two = rt.image.camera_series([BRICK, BRICK], **small_camera)
        self.assertEqual(len(two.pictures), 2)
        for wrong in ({}, {"pixels": [1]}, {"v_deg": [1], "h_deg": [2]}, {"tone": ["log"]}, [1, 2]):
            with self.subTest(values=wrong), self.assertRaises(rt.InputError) as refused:
                rt.image.camera_series(BRICK, wrong)
            self.assertEqual(refused.exception.key, "values")
        with self.assertRaises(rt.InputError):
            rt.image.camera_series([BRICK, BRICK], {"v_deg": [1, 2]}, **small_camera)
        reflector = program.example("reflex_reflector.toml")
        self.assertEqual(
            program.answer(rt.image.road, reflector, distance_m=[30], dye="red"),
            program.document("image", reflector, "--road", "--road-distance-m=30", "--dye=red"),
        )
        self.assertEqual(
            program.answer(
                rt.image.road,
                reflector,
                distance_m=[30],
                lamp=BEAM,
                lamp_height_m=0.8,
                lamp_aim_deg=0.5,
            ),
            program.document(
                "image",
                reflector,
                "--road",
                "--road-distance-m=30",
                f"--lamp={BEAM}",
                "--lamp-height-m=0.8",
                "--lamp-aim-deg=0.5",
            ),
        )
        sign = rt.image.road(
            reflector,
            distance_m=[30],
            mount="sign",
            reflector_mm=(600, 400),
            outline="rectangle",
            symbol="none",
            pixels=(80, 60),
        )
        self.assertEqual(sign["road"]["Y"].shape, (60, 80))
        self.assertLessEqual({"reflected", "veil", "R", "G", "B"}, set(sign["road"]))
        self.assertAlmostEqual(
            sign.document["scene"]["reflector_area_m2"],
            0.6 * 0.4 - (0.6 - 0.016) * (0.4 - 0.016) + (0.6 - 0.04) * (0.4 - 0.04),
        )


class Studies(unittest.TestCase):
    def test_sweep_of_a_design_is_that_of_a_study_file(self):
        text = f"""schema = "retrace.study/1"
            title = "RTP brick array, 1.0 mm elements"
            design = "{BRICK}"
            [analysis]
            engine = "montecarlo"
            samples = 64
            [machining]
            tool_width_mm = 0.5
            [[parameter]]
            key = "element.base_mm"
            values = [0.5, 1.0]
            [[parameter]]
            key = "body.thickness_mm"
            values = [2.0, 3.0]
            [[quantity]]
            kind = "rre"
            [[quantity]]
            kind = "machining_time_h"
            """
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "study.toml")
            with open(file, "w", encoding="utf-8") as stream:
                stream.write(text)
            expected = json.loads(rt.sweep(file).json)["points"]
        found = rt.sweep(
            rt.Design.load(BRICK),
            {"element.base_mm": np.array([0.5, 1]), "body.thickness_mm": [2.0, 3.0]},
            quantities=["rre", "machining_time_h"],
            analysis={"engine": "montecarlo", "samples": 64},
            machining={"tool_width_mm": 0.5},
        )
        self.assertEqual(json.loads(found.json)["points"], expected)
        dataset = found.to_xarray()
        self.assertEqual(dataset.rre.shape, (2, 2))
        self.assertEqual(
            dataset.rre.sel({"element.base_mm": 1, "body.thickness_mm": 2}).item(),
            expected[2]["rre"],
        )
        self.assertEqual(dataset["machining_time_h"].attrs["units"], "h")
        self.assertEqual(found["rre"].tolist(), found.to_pandas()["rre"].tolist())

    def test_changed_designs_are_swept_as_they_are(self):
        design = rt.Design.load(PRISM).replace({"element.width_mm": 0.6, "element.base_mm": 9})
        found = rt.sweep(design, {"element.base_mm": [0.5]}, quantities=["entrance_area_mm2"])
        self.assertAlmostEqual(found["entrance_area_mm2"][0], 0.5 * 0.6)

    def test_store_and_resume(self):
        arguments = (rt.Design.load(PRISM), {"element.base_mm": [0.4, 0.5]})
        with tempfile.TemporaryDirectory() as folder:
            store = os.path.join(folder, "s.sqlite")
            first = rt.sweep(*arguments, store=store)
            with self.assertRaises(rt.InputError):
                rt.sweep(*arguments, store=store)
            again = rt.sweep(*arguments, store=store, resume=True)
            self.assertEqual(again["rre"].tolist(), first["rre"].tolist())
            rt.sweep(*arguments, store=store, overwrite=True)

    def test_functions_of_a_result(self):
        def worst(result):
            return result.rre.min()

        design = rt.Design.load(PRISM)
        found = rt.sweep(
            design,
            {"element.base_mm": [0.4, -1, 0.5]},
            quantities=["rre", worst, lambda r: np.nan],
            of=lambda d: rt.rre(d, incidence_deg=[0, 10]),
        )
        self.assertEqual(found.failed, 1)
        expected = [
            rt.rre(design.replace({"element.base_mm": base}), incidence_deg=[0, 10]).rre.min()
            for base in (0.4, 0.5)
        ]
        np.testing.assert_array_equal(found["worst"], [expected[0], np.nan, expected[1]])
        self.assertIn("base_mm", found.reason[1])
        alone = rt.sweep(
            design,
            {"element.base_mm": [0.4, 0.5], "body.thickness_mm": [1.0, 2.0]},
            quantities={"least": worst},
            progress=lambda share: None,
        )
        self.assertEqual(alone["least"].shape, (4,))
        self.assertEqual(alone["body.thickness_mm"].tolist(), [1, 2, 1, 2])
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            rt.sweep(design, {"element.base_mm": [0.4]}, quantities=[lambda r: 1 / 0])
        with self.assertRaises(rt.InputError):
            rt.sweep(design, {"element.base_mm": [0.4]}, quantities=[lambda r: "much"])

    def test_objective_of_a_function(self):
        import sys

        design = rt.Design.load(PRISM)
        for scipy in (True, False):
            with self.subTest(scipy=scipy):
                modules = {} if scipy else {"scipy": None, "scipy.optimize": None}
                before = {name: sys.modules.get(name) for name in modules}
                sys.modules.update(modules)
                try:
                    found = rt.optimize(
                        design,
                        {"element.base_mm": (0.2, 1), "body.thickness_mm": (0.5, 3)},
                        minimize=True,
                        objective=lambda i: (i.element_depth_mm - 0.3) ** 2
                        + (i.thickness_mm - 1) ** 2,
                        of=lambda d: _Depth(rt.inspect(d), d),
                        evaluations=300,
                    )
                finally:
                    for name, module in before.items():
                        sys.modules.pop(name) if module is None else sys.modules.update(
                            {name: module}
                        )
                self.assertAlmostEqual(found.values["element.base_mm"], 0.6, 2)
                self.assertAlmostEqual(found.values["body.thickness_mm"], 1, 2)
                self.assertEqual(found.design["element.base_mm"], found.values["element.base_mm"])
                self.assertEqual("scipy" in found.method, scipy)

    def test_optimum_of_a_design(self):
        found = rt.optimize(
            BRICK,
            {"element.base_mm": (0.5, 5)},
            objective="entrance_area_mm2",
            quantities=["element_depth_mm"],
            constraints={"lens_thickness_mm": (None, 4)},
            optimize={"scan": 5},
        )
        self.assertTrue(found.is_feasible)
        self.assertLessEqual(found.best["lens_thickness_mm"], 4 + 1e-6)
        self.assertEqual(found.best_design["element.base_mm"], found.best["element.base_mm"])
        self.assertEqual(len(found.designs.rows), found.evaluations)
        self.assertEqual(sum(found.designs["feasible"]) > 0, True)
        self.assertIn("<svg", found._repr_svg_())
        none = rt.optimize(
            BRICK,
            {"element.base_mm": (0.5, 5)},
            objective="entrance_area_mm2",
            constraints={"lens_thickness_mm": (None, 1)},
            optimize={"scan": 5},
        )
        self.assertFalse(none.is_feasible)
        with self.assertRaises(rt.InputError):
            none.best_design

    def test_tolerance_of_a_design(self):
        found = rt.tolerance(
            PRISM,
            {"surface.dihedral_error_arcmin": {"distribution": "normal", "mean": 0, "sigma": 3}},
            constraints={"rre": (0.96, None)},
            tolerance={"samples": 16},
        )
        self.assertEqual(found.parts, 32)
        self.assertIn("<svg", found._repr_svg_())
        self.assertEqual(found.quantities.quantity.tolist(), ["rre"])


class _Depth:
    """Values that the objective function uses."""

    def __init__(self, inspection, design):
        self.element_depth_mm = inspection.element_depth_mm
        self.thickness_mm = design["body.thickness_mm"]


class Surfaces(unittest.TestCase):
    def test_heights_in_memory_are_those_of_a_file(self):
        of_file = rt.metrology(program.example("facet_height_map.txt"))
        again = rt.metrology(of_file.heights_nm, pixel_um=of_file.pixel_um, form="none")
        for name in ("sa_nm", "roughness_sq_nm", "waviness_sa_nm"):
            self.assertAlmostEqual(getattr(again, name), getattr(of_file, name), 9)
        self.assertEqual(of_file.heights_nm.shape, (of_file.rows, of_file.columns))
        self.assertEqual(np.isnan(of_file.heights_nm).sum(), of_file.missing)
        self.assertFalse(of_file.roughness_nm.flags.writeable)
        self.assertIn("<svg", of_file._repr_svg_())
        rough = rt.Design.load(BRICK).replace(of_file.changes)
        self.assertEqual(rough["surface.roughness_sq_nm"], of_file.surface["roughness_sq_nm"])

    def test_bad_heights(self):
        good = np.random.default_rng(1).normal(size=(16, 16))
        for heights, keywords, key in (
            (good, {}, "pixel_um"),
            (good, {"pixel_um": -1}, "pixel_um"),
            (good, {"pixel_um": (1, 1, 1)}, "pixel_um"),
            (good[:, :4], {"pixel_um": 1}, "heights"),
            (good[None], {"pixel_um": 1}, "heights"),
            (good.astype(str), {"pixel_um": 1}, "heights"),
            ([[1, 2], [3]], {"pixel_um": 1}, "heights"),
            (good * np.inf, {"pixel_um": 1}, "heights"),
            (good, {"pixel_um": 1, "form": "sphere"}, "form"),
            (good, {"pixel_um": 1, "height_unit": "mm"}, "height_unit"),
            (np.zeros((0, 9)), {"pixel_um": 1}, "heights"),
            (good * 1j, {"pixel_um": 1}, "heights"),
            (None, {"pixel_um": 1}, "heights"),
        ):
            with self.subTest(key=key, keywords=keywords):
                with self.assertRaises(rt.InputError) as caught:
                    rt.metrology(heights, **keywords)
                self.assertEqual(caught.exception.key, key)

    def test_a_map_without_a_height_is_refused(self):
        with self.assertRaises(rt.InputError):
            rt.metrology(np.full((16, 16), np.nan), pixel_um=1)


class Pictures(unittest.TestCase):
    def test_maps_are_arrays(self):
        found = rt.image.detector(
            BRICK, samples=2048, engine="montecarlo", pixels=40, angle_pixels=11
        )
        self.assertEqual(found["angular"]["per_sr"].shape, (11, 11))
        self.assertFalse(found["irradiance"]["leaving"].flags.writeable)
        self.assertTrue(found["irradiance"].drawing.png.startswith(b"\x89PNG"))
        self.assertEqual(found["irradiance"].to_xarray()["leaving"].dims, ("row", "column"))
        self.assertIn("detector", repr(found))

    def test_bad_arguments(self):
        for call, keywords, key in (
            (rt.image.detector, {"pixels": 0}, "pixels"),
            (rt.image.detector, {"incidence_deg": [1, 2]}, "incidence_deg"),
            (rt.image.detector, {"engine": "cell"}, "engine"),
            (rt.image.camera, {"pixels": 400}, "pixels"),
            (rt.image.camera, {"eye_mm": (1, 2)}, "eye_mm"),
            (rt.image.camera, {"film_mm": (1, 2, 3)}, "film_mm"),
            (rt.image.camera, {"passes": 0}, "passes"),
            (rt.image.camera, {"noise": "low"}, "noise"),
            (rt.image.road, {"distance_m": []}, "distance_m"),
            (rt.image.road, {"lamp_cd": 0}, "lamp_cd"),
            (rt.image.road, {"mount": "sign", "mast_m": 1}, "mast_m"),
            (rt.image.road, {"eye_height_m": -1}, "eye_height_m"),
            (rt.image.road, {"lamp": "lamp.txt"}, "lamp"),
            (rt.image.camera, {"lamp": 3}, "lamp"),
        ):
            with self.subTest(keywords=keywords):
                with self.assertRaises(rt.InputError) as caught:
                    call(BRICK, **keywords)
                self.assertEqual(caught.exception.key, key)


class Pages(unittest.TestCase):
    def test_of_several_results(self):
        results = [
            rt.rre(PRISM, incidence_deg=[0, 10], engine="exact", footprint=True),
            rt.inspect(PRISM),
            rt.sweep(rt.Design.load(PRISM), {"element.base_mm": [0.4, 0.5]}),
            rt.rre(PRISM),
        ]
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "page.html")
            page = rt.report(results, file, title="Mine <here>")
            with open(file, encoding="utf-8") as stream:
                self.assertEqual(stream.read(), page.html)
        self.assertIn("Mine &lt;here&gt;", page.html)
        for name in ("rre.json", "rre_2.json", "footprint.json", "inspect.json", "sweep.json"):
            self.assertIn(name, page.html)
        self.assertIn("<svg", page.html)

    def test_bad_results(self):
        for results in ([], [3], None, "rre.json"):
            with self.assertRaises(rt.InputError):
                rt.report(results)


class Arguments(unittest.TestCase):
    def test_bad_input(self):
        design = rt.Design.load(PRISM)
        base = {"element.base_mm": [1.0]}
        for call, arguments, keywords, key in (
            (rt.sweep, [design], {}, "parameters"),
            (rt.sweep, [design, {}], {}, "parameters"),
            (rt.sweep, [design, {"element.base_mm": "1"}], {}, "parameters"),
            (rt.sweep, [design, {"element.base_mm": []}], {}, "parameters"),
            (rt.sweep, [design, {3: [1]}], {}, "parameters"),
            (rt.sweep, [design, [1]], {}, "parameters"),
            (rt.sweep, [design, base], {"quantities": []}, "quantities"),
            (rt.sweep, [design, base], {"quantities": [3]}, "quantities"),
            (rt.sweep, [design, base], {"resume": True}, "resume"),
            (rt.sweep, [design, base], {"of": 3}, "of"),
            (rt.sweep, [design, base], {"analysis": 3}, "analysis"),
            (rt.sweep, [design, base], {"changes": {}}, "changes"),
            (rt.sweep, [design, base], {"quantities": [len], "store": "s.sqlite"}, "store"),
            (rt.sweep, [design, {"element.base": [1]}], {}, None),
            (rt.sweep, ["none.toml"], {}, None),
            (rt.sweep, [design, base], {"quantities": ["rrre"]}, None),
            (rt.tolerance, [design, base], {}, None),
            (rt.tolerance, [design, base], {"quantities": [len]}, "quantities"),
            (
                rt.optimize,
                [design, {"element.base_mm": (1, 2)}],
                {"constraints": {"rre": 3}},
                "constraints",
            ),
            (rt.optimize, [design, {"element.base_mm": (1, 2)}], {"constraints": 3}, "constraints"),
            (rt.optimize, [design, {"element.base_mm": (1, 2)}], {"objective": 3}, "objective"),
            (rt.optimize, [design, {"element.base_mm": (2, 1)}], {"objective": len}, "parameters"),
            (
                rt.optimize,
                [design, {"element.base_mm": (1, 2)}],
                {"objective": lambda r: "x"},
                "objective",
            ),
        ):
            with self.subTest(call=call.__name__, arguments=arguments[1:], keywords=keywords):
                with self.assertRaises(rt.InputError) as caught:
                    call(*arguments, **keywords)
                if key is not None:
                    self.assertEqual(caught.exception.key, key)


if __name__ == "__main__":
    unittest.main()
