"""Tests of rays in memory and in files: results equal those of the program, and wrong arrays are
refused by name."""

import csv
import os
import tempfile
import unittest

import numpy as np

import program
import retrace as rt

BRICKS = program.example("rtp_brick_1mm.toml")


def some_rays(count, seed=5):
    """Returns rays from all directions to the center of the part."""
    random = np.random.default_rng(seed)
    directions = random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return np.array([25.0, 25.0, 0.0]) + random.normal(size=(count, 3)) - 60 * directions, directions


class Trace(unittest.TestCase):
    def test_accounts_are_those_of_the_library(self):
        names = [account.name.lower() for account in rt.RayAccount]
        self.assertEqual(names, rt._core.ray_accounts())
        self.assertEqual([int(account) for account in rt.RayAccount], list(range(len(names))))

    def test_numbers_are_those_of_the_program(self):
        origins, directions = some_rays(500)
        with tempfile.TemporaryDirectory() as folder:
            source = os.path.join(folder, "rays.csv")
            with open(source, "w", encoding="utf-8") as file:
                file.write("x_mm,y_mm,z_mm,dx,dy,dz,power_w\n")
                for row in np.hstack([origins, directions, np.full((500, 1), 2.0)]).tolist():
                    file.write(",".join(map(repr, row)) + "\n")
            out = os.path.join(folder, "out.csv")
            program.run(
                "rays", BRICKS, "--source", source, "--split=0.1", "--stokes", "--seed=4", "-o", out
            )
            with open(out, encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
        found = rt.trace(BRICKS, origins, directions, (2, 0, 0, 0), split=0.1, seed=4)
        self.assertEqual(len(found), len(rows))
        self.assertEqual(
            [rt.RayAccount(account).name.lower() for account in found.account],
            [row["account"] for row in rows],
        )
        np.testing.assert_array_equal(found.incident, [int(row["ray"]) - 1 for row in rows])
        for names, array in (
            (("x_mm", "y_mm", "z_mm"), found.origins),
            (("dx", "dy", "dz"), found.directions),
            (("axis_x", "axis_y", "axis_z"), found.axes),
        ):
            told = np.array([[float(row[name]) for name in names] for row in rows])
            np.testing.assert_allclose(array, told, rtol=0, atol=1e-12)
        power = np.array([float(row["power_w"]) for row in rows])
        np.testing.assert_allclose(found.power_out, power, rtol=1e-12)
        for k, name in enumerate(("s1", "s2", "s3")):
            share = np.array([float(row[name]) for row in rows])
            np.testing.assert_allclose(found.stokes[:, 1 + k], power * share, rtol=0, atol=1e-12)

    def test_power_is_kept(self):
        origins, directions = some_rays(300)
        found = rt.trace(BRICKS, origins, directions, split=0, keep_missed=True)
        self.assertAlmostEqual(sum(found.ledger.values()), 1.0, places=9)
        taken = sum(found.ledger[name] for name in ("absorbed", "truncated", "lost"))
        self.assertAlmostEqual(found.power_out.sum(), found.power * (1 - taken), places=6)
        missed = found.account == rt.RayAccount.MISSED
        self.assertAlmostEqual(found.power_out[missed].sum(), found.power * found.ledger["missed"])
        np.testing.assert_array_equal(found.origins[missed], origins[found.incident[missed]])
        self.assertRegex(repr(found), "^<TracedRays: rays 300")
        with self.assertRaises(ValueError):
            found.origins[0] = 0

    def test_wavelengths_and_polarisation_go_in(self):
        plate = rt.Design.parse(
            '[part]\nplate_mm = [10, 10]\n[body]\nthickness_mm = 2\nmaterial = "N-BK7"\n', "plate.toml"
        )
        tilt = np.deg2rad(40)
        way = np.array([np.sin(tilt), 0, -np.cos(tilt)])
        origins = np.tile(np.array([3, 5, 2]) - 4 * way, (3, 1))
        colours = [440.0, 550.0, 700.0]
        found = rt.trace(
            plate, origins, np.tile(7 * way, (3, 1)), wavelength_nm=colours, split=0, seed=2
        )
        straight = found.power_out > 0.8
        np.testing.assert_array_equal(found.wavelength_nm[straight], colours)
        shift = found.origins[straight, 0] - 3
        self.assertTrue((np.diff(shift) > 0).all())  # red light is refracted less
        in_plane = np.cross(way, [0, 1, 0])
        reflected = {
            name: rt.trace(plate, origins[:1], way[None], (1, 1, 0, 0), axes=axis[None], split=0).ledger[
                "front_specular"
            ]
            for name, axis in (("s", np.array([0.0, 1, 0])), ("p", in_plane))
        }
        self.assertGreater(reflected["s"], 2 * reflected["p"])

    def test_wrong_arrays_are_refused_by_name(self):
        origins, directions = some_rays(4)
        wrong = [
            ("origins", {"origins": origins[:, :2]}),
            ("origins", {"origins": "here"}),
            ("origins", {"origins": origins * np.nan}),
            ("directions", {"directions": directions[:3]}),
            ("directions", {"directions": directions * 0}),
            ("stokes", {"stokes": np.ones((3, 4))}),
            ("stokes", {"stokes": (1, 1, 1, 1)}),
            ("stokes", {"stokes": (-1, 0, 0, 0)}),
            ("axes", {"axes": directions, "stokes": (1, 1, 0, 0)}),
            ("wavelength_nm", {"wavelength_nm": [0.55]}),
            ("wavelength_nm", {"wavelength_nm": [500, 600]}),
            ("split", {"split": 2}),
        ]
        for key, changes in wrong:
            with self.subTest(key=key, changes=changes):
                arguments = {"origins": origins, "directions": directions, **changes}
                with self.assertRaises(rt.InputError) as caught:
                    rt.trace(BRICKS, **arguments)
                if key != "axes":  # the library reports errors in axes without a key
                    self.assertEqual(caught.exception.key, key)


class Files(unittest.TestCase):
    def test_the_document_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "out.tm25ray")
            arguments = ["--emitter=gaussian", "--rays=3000", "--disc-mm=2", "--incidence=10"]
            expected = program.document("rays", BRICKS, *arguments, "-o", out)
            with open(out, "rb") as file:
                rays_of_program = file.read()
            given = {"emitter": "gaussian", "rays": 3000, "disc_mm": 2, "incidence_deg": 10}
            found = program.answer(rt.rays, BRICKS, **given, out=out)
            self.assertEqual(found, expected)
            with open(out, "rb") as file:
                self.assertEqual(file.read(), rays_of_program)

    def test_wrong_requests_are_refused(self):
        for key, given in (
            ("source", {}),
            ("source", {"source": "a.csv", "emitter": "gaussian"}),
            ("emitter", {"emitter": "laser"}),
            ("at_mm", {"emitter": "gaussian", "at_mm": [1, 2]}),
            ("out", {"emitter": "gaussian", "out": "rays.txt"}),
        ):
            with self.subTest(**given), self.assertRaises(rt.InputError) as caught:
                rt.rays(BRICKS, **given)
            self.assertEqual(caught.exception.key, key)


if __name__ == "__main__":
    unittest.main()
