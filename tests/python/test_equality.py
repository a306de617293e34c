"""Tests that the package gives the same document as the program, byte for byte, or the same error,
for every example and command."""

import json
import os
import re
import tempfile
import unittest

import numpy as np
import program
import retrace as rt

RAYS = {"engine": "montecarlo", "samples": 256}


class Equality(unittest.TestCase):
    maxDiff = 2000

    def walk(self, files, of_program, of_package, least):
        """Compares program and package for all files. At least `least` files must give a result."""
        answers = 0
        for file in files:
            with self.subTest(file=os.path.relpath(file, program.EXAMPLES)):
                expected = of_program(file)
                self.assertEqual(of_package(file), expected)
                answers += expected[0] is not None
        self.assertGreaterEqual(answers, least)

    def test_rre_by_rays(self):
        self.walk(
            program.some_designs(0),
            lambda file: program.document(
                "rre",
                file,
                "--incidence=-20,0,35.5",
                "--azimuth=0,30",
                "--engine=montecarlo",
                "--samples=256",
                "--seed=3",
            ),
            lambda file: program.answer(
                rt.rre, file, incidence_deg=[-20, 0, 35.5], azimuth_deg=[0, 30], **RAYS, seed=3
            ),
            least=program.least(20),
        )

    def test_rre_as_it_chooses(self):
        names = [
            "rtp_brick_5mm.toml",
            "rtp_single_0p45mm.toml",
            "honeycomb_infinite.toml",
            "beads_n193.toml",
        ]
        self.walk(
            map(program.example, names),
            lambda file: program.document("rre", file, "--incidence=0,10", "--target-error=1e-3"),
            lambda file: program.answer(rt.rre, file, incidence_deg=[0, 10], target_error=1e-3),
            least=4,
        )

    def test_chosen_incidences_and_derivatives(self):
        file = program.example("rtp_single_0p45mm.toml")
        self.assertEqual(
            program.answer(rt.rre, file, incidence_deg=[], incidence_spans_deg=[(0, 20)]),
            program.document("rre", file, "--incidence=0:20:auto"),
        )
        self.assertEqual(
            program.answer(rt.rre, file, incidence_deg=5, derivatives=True, engine="exact"),
            program.document("rre", file, "--incidence=5", "--derivatives", "--engine=exact"),
        )

    def test_several_designs(self):
        files = [program.example("rtp_single_0p45mm.toml"), program.example("rtp_single_10mm.toml")]
        self.assertEqual(program.answer(rt.rre, files), program.document("rre", *files))

    def test_changes(self):
        file = program.example("rtp_single_0p45mm.toml")
        changes = {
            "element.base_mm": 0.5,
            "body.material": "PC",
            "detector.acceptance_half_angle_deg": [0.25, 1],
        }
        of_program = program.document(
            "rre",
            file,
            "--set",
            "element.base_mm=0.5",
            "--set",
            "body.material=PC",
            "--set",
            "detector.acceptance_half_angle_deg=[0.25, 1]",
        )
        self.assertIsNotNone(of_program[0])
        self.assertEqual(program.answer(rt.rre, rt.Design.load(file, changes)), of_program)
        self.assertEqual(program.answer(rt.rre, rt.Design.load(file).replace(changes)), of_program)

    def test_footprint(self):
        file = program.example("rtp_single_0p45mm.toml")
        with tempfile.TemporaryDirectory() as folder:
            code, _, err = program.run(
                "rre", file, "--incidence=0,10", "--footprint", "--out", folder
            )
            self.assertEqual(code, 0, err)
            with open(os.path.join(folder, "footprint.json"), encoding="utf-8") as text:
                expected = text.read()
            with open(os.path.join(folder, "rre.svg"), encoding="utf-8") as text:
                curve = text.read()
        found = rt.footprint(file, incidence_deg=[0, 10])
        self.assertEqual(found.json, expected)
        self.assertEqual(found.rre.drawings["rre"].svg, curve)

    def test_photometry(self):
        self.walk(
            program.some_designs(0),
            lambda file: program.document(
                "photometry",
                file,
                "--standard=r150",
                "--class=IA",
                "--colour=red",
                "--area-cm2=30",
                "--engine=montecarlo",
                "--samples=64",
                "--no-advice",
            ),
            lambda file: program.answer(
                rt.photometry,
                file,
                **program.RED_R150,
            ),
            least=4,
        )

    def test_ranging(self):
        file = program.example("round_cube.toml")
        cubes = program.example("ranging/sphere.toml")
        self.assertEqual(
            program.answer(rt.ranging, file, wavelength_nm=[532, 1064], orbit_km=5860),
            program.document("ranging", file, "--wavelength=532,1064", "--orbit-km=5860"),
        )
        found = rt.ranging(file, cubes=cubes, pulse_ps=50, shots=20, polarisation="linear")
        self.assertEqual(len(found.cubes["range_mm"]), found.points.ranges.lit_cubes[0])
        self.assertEqual(len(found.shots["centroid_mm"]), 20)
        far_field = found.map
        self.assertEqual(far_field.total_m2.shape, (81, 81))
        np.testing.assert_allclose(
            far_field.parallel_m2 + far_field.crossed_m2, far_field.total_m2, rtol=1e-6
        )

    def test_inspect(self):
        self.walk(
            program.some_designs(2),
            lambda file: program.document("inspect", file),
            lambda file: program.answer(rt.inspect, file),
            least=program.least(20),
        )

    def test_export(self):
        with tempfile.TemporaryDirectory() as folder:
            for what in ("array", "element"):
                file_of_program = os.path.join(folder, "part.stl")

                def of_package(file):
                    found = program.answer(rt.export, file, file_of_program, what=what)
                    return (*found, self.content(file_of_program))

                def of_program(file):
                    found = program.document("export", file, file_of_program, f"--what={what}")
                    return (*found, self.content(file_of_program))

                self.walk(program.some_designs(1), of_program, of_package, least=2)

    def test_export_material(self):
        with tempfile.TemporaryDirectory() as folder:
            file_of_program = os.path.join(folder, "part.json")

            def of_package(file):
                found = program.answer(
                    rt.export_material,
                    file,
                    file_of_program,
                    entrance_deg=1,
                    window_deg=0.1,
                    max_directions=64,
                    error=0.2,
                )
                return (*found, self.content(file_of_program))

            def of_program(file):
                found = program.document(
                    "export",
                    file,
                    file_of_program,
                    "--entrance-deg=1",
                    "--window-deg=0.1",
                    "--max-directions=64",
                    "--error=0.2",
                )
                return (*found, self.content(file_of_program))

            names = ["rtp_single_0p45mm.toml", "beads_n193.toml"]
            self.walk(map(program.example, names), of_program, of_package, least=1)

    @staticmethod
    def content(file):
        """Returns the content of a file and removes the file."""
        if not os.path.exists(file):
            return b""
        with open(file, "rb") as stream:
            content = stream.read()
        os.remove(file)
        return content

    def test_job_and_fabricate(self):
        fabricated = 0
        with tempfile.TemporaryDirectory() as folder:
            for file in program.some_designs(2):
                for strategy in ("two-step", "dmc"):
                    with self.subTest(
                        file=os.path.relpath(file, program.EXAMPLES), strategy=strategy
                    ):
                        options = ("--tool-width-mm=0.4", f"--strategy={strategy}")
                        expected = program.document("job", file, *options)
                        self.assertEqual(
                            program.answer(rt.job, file, tool_width_mm=0.4, strategy=strategy),
                            expected,
                        )
                        if expected[0] is None or "100cm2" in file:
                            continue
                        job = rt.job(file, tool_width_mm=0.4, strategy=strategy)
                        job_file = os.path.join(folder, "job.toml")
                        program.run("job", file, *options, "-o", job_file)
                        with open(job_file, encoding="utf-8") as text:
                            # The job of the package has no file yet, so its text contains no
                            # folder of the design.
                            told = re.sub(r'(?m)^design = ".*/', 'design = "', text.read())
                        self.assertEqual(job.text, told)
                        with open(job_file, "w", encoding="utf-8") as text:
                            text.write(job.text)
                        made = program.document("fabricate", "job.toml", "-o", "nc", folder=folder)
                        self.assertEqual(program.answer(rt.fabricate, job), made)
                        if made[0] is None:
                            continue
                        fabricated += 1
                        for name, text in rt.fabricate(job).programs.items():
                            self.assertEqual(
                                self.content(os.path.join(folder, "nc", name)).decode(), text
                            )
        self.assertGreaterEqual(fabricated, 2)

    def test_verify(self):
        job = rt.job(program.example("rtp_brick_5mm.toml"), tool_width_mm=1)
        made = rt.fabricate(job)
        ((name, text),) = made.programs.items()
        with tempfile.TemporaryDirectory() as folder:
            job.save(os.path.join(folder, "job.toml"))
            made.save(folder)
            left = os.path.join(folder, "left.toml")
            expected = program.document("verify", "job.toml", name, folder=folder)
            program.run("verify", "job.toml", name, "--as-machined", left, folder=folder)
            verified = rt.verify(job, made)
            self.assertEqual((program.same(verified.json), ""), expected)
            with open(left, encoding="utf-8") as file:
                self.assertEqual(verified.as_machined.text, file.read())
            # If a block cuts too deep, there is a finding with the line of this block.
            deeper = {name: text.replace("Z-", "Z-1", 1)}
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(deeper[name])
            found = rt.verify(job, deeper)
            self.assertEqual(
                program.same(found.json),
                program.document("verify", "job.toml", name, folder=folder)[0],
            )
            self.assertEqual(found.verdict, "fail")
            self.assertGreater(found.findings.line[0], 0)

    def test_arrays_are_the_numbers_of_the_document(self):
        result = rt.rre(program.example("honeycomb_daylight.toml"), incidence_deg=[0, 20], **RAYS)
        points = json.loads(result.json)["points"]
        self.assertEqual(result.rre.tolist(), [point["rre"] for point in points])
        self.assertEqual(
            result.ledger["transmitted"].tolist(),
            [point["ledger"]["transmitted"] for point in points],
        )


if __name__ == "__main__":
    unittest.main()
