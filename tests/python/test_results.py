"""Tests of results in Python: arrays, tables, drawings, short texts, designs and solids."""

import json
import os
import pickle
import tempfile
import unittest

import numpy as np

import program
import retrace as rt
from retrace._results import Columns

PRISM = program.example("rtp_single_0p45mm.toml")


class Results(unittest.TestCase):
    def setUp(self):
        self.result = rt.rre(
            PRISM,
            incidence_deg=np.arange(-10, 11, 10),
            azimuth_deg=[0, 30],
            engine="montecarlo",
            samples=64,
        )

    def test_arrays_are_read_only_float64(self):
        for array in (self.result.rre, self.result.std_error, self.result.ledger["absorbed"]):
            self.assertEqual(array.dtype, np.float64)
            self.assertEqual(array.shape, (6,))
            with self.assertRaises(ValueError):
                array[0] = 1

    def test_polar_maps_have_the_values_of_the_points(self):
        result = rt.rre(
            program.example("honeycomb_infinite.toml"),
            incidence_deg=[0, 10, 20],
            azimuth_deg=[0, 90, 180, 270],
            map=True,
        )
        polar = result.polar()
        self.assertEqual(polar.rre.shape, (4, 3))
        np.testing.assert_array_equal(polar.rre.ravel(), result.rre)
        np.testing.assert_array_equal(polar.azimuth_deg, [0, 90, 180, 270])
        self.assertLess(polar.rre.min(), polar.mean_rre)
        self.assertGreater(polar.rre.max(), polar.mean_rre)
        self.assertIn("map", result.drawings)
        self.assertNotIn("map_difference", result.drawings)
        with self.assertRaises(rt.InputError):
            result.polar(1)
        with self.assertRaises(rt.InputError):
            self.result.polar()

    def test_maps_of_photometry_have_the_values_of_the_points(self):
        given = {
            "standard": "d4956",
            "class_": "I",
            "colour": "white",
            "area_cm2": 100,
            "light": "design",
            "advice": False,
        }
        design = rt.Design.load(program.example("honeycomb_infinite.toml"))
        result = rt.photometry(
            design,
            compare=design,
            map=True,
            map_entrance_deg=[-4, 0, 30],
            map_observation_deg=[0.2, 0.5],
            **given,
        )
        found = result.coefficient_map()
        self.assertEqual(found.r_a.shape, (3, 2))
        for point in result.points.rows:
            entrance = np.flatnonzero(found.entrance_deg == -point["v_deg"])[0]
            observation = np.flatnonzero(found.observation_deg == point["observation_deg"])[0]
            self.assertAlmostEqual(
                found.r_a[entrance, observation] / point["r_a_cd_per_lx_m2"], 1, delta=1e-3
            )
            self.assertAlmostEqual(
                found.r_i[entrance, observation] / point["value_mcd_per_lx"], 1, delta=1e-3
            )
        other = result.coefficient_map(design=1)
        np.testing.assert_array_equal(found.ratio(other), np.ones((3, 2)))
        np.testing.assert_array_equal(found.difference(other), np.zeros((3, 2)))
        self.assertIn("map", result.drawings)
        self.assertIn("map_ratio", result.drawings)
        with self.assertRaises(rt.InputError):
            result.coefficient_map(rotation_deg=17)
        plain = rt.photometry(design, **given)
        self.assertNotIn("map", plain.drawings)
        with self.assertRaises(rt.InputError):
            plain.coefficient_map()
        with self.assertRaises(rt.InputError):
            rt.photometry(design, compare=design, **given)

    def test_fields_of_cells_are_added(self):
        given = {
            "standard": "d4956",
            "class_": "I",
            "colour": "white",
            "area_cm2": 100,
            "light": "design",
            "advice": False,
        }
        design = rt.Design.load(
            program.example("honeycomb_infinite.toml"), {"element.aperture_mm": 0.15}
        )
        intensities = rt.photometry(design, **given)
        self.assertNotIn("cell_interference", intensities.document)
        fields = rt.photometry(design.replace({"array.depth_spread_nm": 10}), **given)
        self.assertEqual(fields.document["cell_interference"]["depth_spread_nm"], 10)
        self.assertFalse(
            np.allclose(
                fields.points.value_mcd_per_lx, intensities.points.value_mcd_per_lx, rtol=0.01
            )
        )

    def test_keys_that_are_left_out_are_nan(self):
        exact = rt.rre(program.example("honeycomb_infinite.toml"), incidence_deg=[0, 10])
        depths = [point.get("depth") for point in json.loads(exact.json)["points"]]
        self.assertIn(None, depths)
        np.testing.assert_array_equal(
            exact.depth, [np.nan if depth is None else depth for depth in depths]
        )

    def test_unknown_names_say_the_nearest(self):
        with self.assertRaisesRegex(AttributeError, r"\bstd_error\b"):
            self.result.std_eror
        with self.assertRaisesRegex(KeyError, r"\btransmitted\b"):
            self.result.ledger["transmited"]

    def test_one_line(self):
        line = repr(self.result)
        self.assertNotIn("\n", line)
        self.assertRegex(line, r"^<RreResult: title Single RTP.*rre .* to .*>$")

    def test_they_show_themselves(self):
        self.assertTrue(self.result._repr_svg_().startswith("<?xml"))
        self.assertIn("<path", self.result._repr_svg_())
        self.assertIn("footprint", dir(self.result))
        verdicts = rt.photometry(
            program.example("rtp_brick_2mm.toml"),
            **program.RED_R150,
        )
        self.assertIn("background:#", verdicts._repr_html_())
        self.assertIn(verdicts.verdict, repr(verdicts))

    def test_drawings_are_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, begin in (("curve.svg", b"<?xml"), ("curve.png", b"\x89PNG")):
                file = os.path.join(folder, name)
                self.result.drawings["rre"].save(file)
                with open(file, "rb") as stream:
                    self.assertTrue(stream.read().startswith(begin))
        with self.assertRaises(rt.OutputError):
            self.result.save("no/such/folder/rre.json")

    def test_pandas(self):
        frame = self.result.to_pandas()
        self.assertEqual(len(frame), 6)
        self.assertEqual(frame["rre"].tolist(), self.result.rre.tolist())
        self.assertEqual(frame["ledger_lost"].tolist(), self.result.ledger["lost"].tolist())
        self.assertEqual(frame.attrs["seed"], 1)
        self.assertEqual(frame.attrs["version"], rt.__version__)

    def test_xarray(self):
        dataset = self.result.to_xarray()
        self.assertEqual(
            dataset.rre.dims,
            ("design", "azimuth_deg", "incidence_deg", "acceptance_half_angle_deg"),
        )
        self.assertEqual(dataset.incidence_deg.attrs["units"], "degree")
        self.assertEqual(dataset.attrs["version"], rt.__version__)
        points = self.result.points
        for k, rre in enumerate(points.rre):
            at = dataset.rre.sel(
                azimuth_deg=points.azimuth_deg[k], incidence_deg=points.incidence_deg[k]
            )
            self.assertEqual(at.item(), rre)

    def test_chosen_incidences_belong_to_their_design(self):
        thin = rt.Design.load(PRISM)
        result = rt.rre(
            [thin, thin.replace({"body.refractive_index": 1.6})],
            incidence_deg=[],
            incidence_spans_deg=[(0.0, 8.0)],
            engine="exact",
        )
        dataset = result.to_xarray()
        angles = dataset.incidence_deg.values
        self.assertTrue((np.diff(angles) > 0).all())
        for design in (0, 1):
            own = result.points.incidence_deg[np.asarray(result.points.design) == design]
            values = dataset.rre.sel(design=design).squeeze()
            self.assertEqual(values.notnull().sum().item(), len(own))

    def test_pickle(self):
        copy = pickle.loads(pickle.dumps(self.result))
        self.assertEqual(copy, self.result)
        self.assertEqual(copy.rre.tolist(), self.result.rre.tolist())
        self.assertIsNone(copy._repr_svg_())
        self.assertIn("incidence", copy._repr_html_())
        self.result._repr_svg_()  # the drawing is pickled with the result
        self.assertEqual(
            pickle.loads(pickle.dumps(self.result))._repr_svg_(), self.result._repr_svg_()
        )
        state = self.result.__getstate__()
        with self.assertRaises(rt.InputError):
            self.result.__setstate__({**state, "_version": "9.1.0"})
        error = pickle.loads(pickle.dumps(rt.InputError("text", "file", 3, "key")))
        self.assertEqual(
            (error.file, error.line, error.key, error.message), ("file", 3, "key", "text")
        )

    def test_former_names_give_the_values_with_a_warning(self):
        found = rt.inspect(program.example("fronts/cats_eye_lenslets.toml"))
        with self.assertWarnsRegex(FutureWarning, r"\bentrance_surface\b"):
            self.assertEqual(found.front, found.entrance_surface)
        prism = rt.inspect(PRISM)
        with self.assertWarnsRegex(FutureWarning, r"\bdead_zone_fraction\b"):
            self.assertEqual(prism.dead_zone_share, prism.dead_zone_fraction)
        columns = Columns([{"max": 1.5}], former={"most": "max"})
        with self.assertWarnsRegex(FutureWarning, r"\bmax\b"):
            self.assertEqual(columns.most.tolist(), [1.5])
        with self.assertWarns(FutureWarning):
            self.assertEqual(columns["most"].tolist(), [1.5])
        self.assertNotIn("most", columns)
        with self.assertRaises(AttributeError):
            columns.least
        design = rt.Design.load(program.example("curved_base.toml"))
        with self.assertWarnsRegex(FutureWarning, r"\bsubstrate\b"):
            self.assertEqual(design["base.sag_mm"], design["substrate.sag_mm"])
        with self.assertWarnsRegex(FutureWarning, r"\bsubstrate.element_axes\b"):
            self.assertEqual(design["base.elements"], design["substrate.element_axes"])
        with self.assertRaises(KeyError):
            design["front.radius_mm"]

    def test_pickles_of_former_versions_get_the_current_names(self):
        found = rt.inspect(PRISM)
        state = found.__getstate__()
        former = state["json"].replace("retrace.inspect/2", "retrace.inspect/1")
        former = former.replace('"dead_zone_fraction"', '"dead_zone_share"')
        self.assertNotEqual(former, found.json)
        copy = rt.Inspection.__new__(rt.Inspection)
        copy.__setstate__({**state, "json": former})
        self.assertEqual(copy, found)
        self.assertEqual(copy.document, found.document)
        later = state["json"].replace("retrace.inspect/2", "retrace.inspect/3")
        with self.assertRaisesRegex(rt.InputError, "retrace.inspect/3"):
            copy.__setstate__({**state, "json": later})

    def test_footprint(self):
        found = rt.footprint(program.example("honeycomb_infinite.toml"), incidence_deg=10)
        self.assertEqual(found.geojson["type"], "FeatureCollection")
        self.assertEqual(len(found.polygons), len(found.efficiency))
        self.assertEqual(found.polygons[0].shape[1], 2)
        area = sum(
            abs(np.dot(p[:-1, 0], p[1:, 1]) - np.dot(p[1:, 0], p[:-1, 1])) / 2 * share
            for p, share in zip(found.polygons, found.efficiency)
        )
        self.assertGreater(area, 0)
        self.assertIn("<svg", found._repr_svg_())
        self.assertEqual(len(found.to_pandas()), found.regions)


class Designs(unittest.TestCase):
    def test_of_keywords(self):
        design = rt.Design(
            title="mine",
            element={"kind": "rtp", "base_mm": np.float64(2), "width_mm": 2},
            array={"arrangement": "single"},
            body={"thickness_mm": 1},
        )
        self.assertEqual(design.title, "mine")
        self.assertEqual(design["element.base_mm"], 2)
        self.assertEqual(rt.Design.parse(design.text)["body.thickness_mm"], 1)
        same = rt.Design.from_dict(
            {
                "title": "mine",
                "element": {"kind": "rtp", "base_mm": 2.0, "width_mm": 2},
                "array": {"arrangement": "single"},
                "body": {"thickness_mm": 1},
            }
        )
        self.assertEqual(same, design)
        self.assertEqual(hash(same), hash(design))
        self.assertNotEqual(design.replace({"title": "yours"}), design)

    def test_keys_are_unset(self):
        """The value None unsets a key. If a key has no effect, a warning names this key and the key
        that takes precedence."""
        plain = rt.Design.load(PRISM).replace({"body.refractive_index": None})
        given = plain.replace({"body.refractive_index": 1.6, "body.material": "PC"})
        self.assertEqual(plain.warnings, [])
        self.assertEqual(len(given.warnings), 1)
        for key in ("body.material", "body.refractive_index"):
            self.assertIn(key, given.warnings[0])
        self.assertIn(given.warnings[0], rt.rre(given).warnings)
        unset = given.replace({"body.refractive_index": None})
        self.assertEqual(unset.warnings, [])
        self.assertEqual(unset.json, plain.replace({"body.material": "PC"}).json)

    def test_every_example_of_its_keys(self):
        """A design that is made from the keys of an example file equals the design in this file."""
        import tomllib

        for file in program.designs():
            with self.subTest(file=file), open(file, "rb") as stream:
                tables = tomllib.load(stream)
                folder = os.getcwd()
                os.chdir(os.path.dirname(file))
                try:
                    again = rt.Design.from_dict(tables)
                finally:
                    os.chdir(folder)
                expected = rt.Design.load(file).document
                self.assertEqual({**again.document, "source": ""}, {**expected, "source": ""})

    def test_pickle(self):
        design = rt.Design.load(PRISM).replace({"element.base_mm": 0.6})
        copy = pickle.loads(pickle.dumps(design))
        self.assertEqual(copy, design)
        self.assertEqual(copy.json, design.json)

    def test_it_shows_itself(self):
        self.assertEqual(repr(rt.Design.load(PRISM)), "<Design 'Single RTP, 0.45 mm': rtp single>")
        self.assertIn("<svg", rt.Design.load(PRISM)._repr_svg_())
        self.assertIsNone(rt.Design.load(program.example("beads_n193.toml"))._repr_svg_())

    def test_inspect(self):
        found = rt.inspect(program.example("rtp_brick_5mm.toml"))
        self.assertEqual(found.elements_full, 3)
        self.assertIn("<svg", found.drawings["plan"].svg)
        self.assertTrue(found.drawings["view"].png.startswith(b"\x89PNG"))

    def test_mesh(self):
        vertices, faces, labels = made = rt.mesh(program.example("rtp_brick_5mm.toml"))
        corners = vertices[faces]
        volume = (
            np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        )
        self.assertAlmostEqual(volume, made.volume_mm3, 9)
        self.assertEqual(len(labels), len(faces))
        self.assertTrue(np.all(vertices[faces[labels == rt.FaceKind.ENTRANCE]][..., 2] == 2))
        for array in made:
            self.assertFalse(array.flags.writeable)
            self.assertFalse(array.flags.owndata)  # the array is not a copy
        del made
        self.assertGreater(vertices.max(), 0)  # the array stays valid

    def test_solids_with_curved_entrance_surfaces(self):
        design = program.example("fronts/cats_eye_lenslets.toml")
        vertices, faces, labels = made = rt.mesh(design, surface_error_mm=0.002)
        self.assertTrue(made.is_manifold)
        entrance = vertices[faces[labels == rt.FaceKind.ENTRANCE]]
        # The lenslets are 0.0225 mm high. The plane between them is 3.01126 mm above the back.
        # Blends are 1 um lower than this plane.
        self.assertAlmostEqual(entrance[..., 2].min(), 3.01126, delta=0.001)
        self.assertAlmostEqual(entrance[..., 2].max(), 3.01126 + 0.0225, delta=0.002)
        fine = rt.mesh(design, surface_error_mm=0.0005)
        self.assertAlmostEqual(made.volume_mm3, fine.volume_mm3, delta=4 * 0.0025)
        self.assertGreater(len(fine.faces), len(faces))
        maps = rt.image.detector(design, samples=4096, pixels=20)
        self.assertEqual(maps.engine, "embree")
        with self.assertRaises(rt.InputError):
            rt.mesh(program.example("rtp_brick_5mm.toml"), surface_error_mm=0.1)

    def test_as_machined(self):
        job = rt.job(program.example("rtp_brick_5mm.toml"), tool_width_mm=1)
        left = rt.verify(job, rt.fabricate(job)).as_machined
        self.assertIn("as machined", left.title)
        self.assertGreater(rt.rre(left, engine="montecarlo", samples=64).rre.max(), 0)

    def test_packages_that_are_not_there_are_named(self):
        import sys

        sys.modules["trimesh"] = None
        try:
            with self.assertRaisesRegex(ImportError, "python3-trimesh"):
                rt.mesh(program.example("rtp_brick_5mm.toml")).to_trimesh()
        finally:
            del sys.modules["trimesh"]


if __name__ == "__main__":
    unittest.main()
