"""Tests of the type hints of the package, of its stubs, and of a program that uses the package."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import retrace as rt

PACKAGE = pathlib.Path(rt.__file__).parent
ALLOWED = str(pathlib.Path(__file__).with_name("stubtest_allowed.txt").resolve())
PROGRAM = """
import numpy as np
import retrace as rt
from retrace import files

tables: files.Design = {"element": {"kind": "rtp", "base_mm": 2.0, "width_mm": 2.0},
                        "array": {"arrangement": "single"}, "body": {"thickness_mm": 1.0}}
design = rt.Design.from_dict(tables).replace({"element.base_mm": 1.5})
result = rt.rre([design, "other.toml"], incidence_deg=np.arange(-40, 41, 5), azimuth_deg=[0, 30], progress=True)
best: float = float(result.rre.max()) + float(result.ledger["transmitted"][0])
regions = rt.footprint(design, incidence_deg=10)
areas: list[float] = [float(abs(polygon).sum()) for polygon in regions.polygons]
table: str = rt.photometry(design, standard="r150", class_="IA", colour="red", area_cm2=30).table
swept = rt.sweep(design, {"element.base_mm": np.geomspace(0.1, 5, 4)}, quantities=["rre", lambda r: r.rre.min()])
found = rt.optimize(design, {"element.base_mm": (0.1, 5)}, objective=lambda r: r.rre[0])
vertices, faces, labels = rt.mesh(design, what="element")
job = rt.job(design, tool_width_mm=0.5, machine="thesis")
rep = rt.verify(job, rt.fabricate(job, dialect="rs274ngc"))
if not rep.passes:
    print(rep.verdict, rep.findings.line, rt.rre(rep.as_machined).std_error)
heights = rt.metrology(np.zeros((16, 16)), pixel_um=0.5).roughness_nm
picture = rt.image.detector(design)["irradiance"]["leaving"]
rt.report([result, regions, rep], "page.html").save("again.html")
try:
    rt.Design.load("none.toml")
except rt.InputError as error:
    print(error.file, error.line, error.key, error.message)
"""
WRONG = {
    'rt.rre("a.toml", incidence="0")': "incidence",
    'rt.rre("a.toml", engine=3)': "engine",
    'rt.photometry("a.toml", standard="r150")': "area_cm2",
    'rt.Design.from_dict({"elements": {}})': "elements",
    'rt.Design.from_dict({"element": {"kind": "prism"}})': "kind",
    'rt.InputError("text").where': "where",
}


def mypy(*arguments, folder):
    """Runs mypy in `folder`, to which it also writes its cache."""
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "MYPYPATH": f"{PACKAGE.parent}{os.pathsep}{folder}"},
        cwd=folder,
        timeout=600,
    )


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # All runs with the same options share one cache, because reading the stubs of numpy takes
        # several seconds.
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = temporary.name

    def test_stubs_are_of_what_is_there(self):
        ended = mypy(
            "mypy.stubtest",
            "--concise",
            "--ignore-unused-allowlist",
            "--allowlist",
            ALLOWED,
            "retrace",
            folder=self.folder,
        )
        self.assertEqual(ended.returncode, 0, ended.stdout)

    def test_package_and_programs(self):
        """The package and a program have no errors. Another program has one error in each line.

        One run checks all three, because reading the stubs of numpy takes several seconds.
        """
        folder = pathlib.Path(self.folder)
        (folder / "right.py").write_text(PROGRAM, encoding="utf-8")
        (folder / "wrong.py").write_text(
            "import retrace as rt\n" + "\n".join(WRONG) + "\n", encoding="utf-8"
        )
        ended = mypy(
            "mypy", "--strict", "-p", "retrace", "-m", "right", "-m", "wrong", folder=folder
        )
        said = [line for line in ended.stdout.splitlines() if ": error" in line]
        self.assertEqual([line for line in said if not line.startswith("wrong.py:")], [])
        for number, word in enumerate(WRONG.values(), 2):
            with self.subTest(line=number):
                self.assertTrue(
                    any(f":{number}: error" in line and word in line for line in said), ended.stdout
                )


if __name__ == "__main__":
    unittest.main()
