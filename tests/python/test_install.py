"""Tests of the installed package: it finds its library and data in any folder."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import program
import retrace as rt

BUILD = pathlib.Path(rt.__file__).parents[2]


class Install(unittest.TestCase):
    def test_it_works_where_it_was_put(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder, "here")
            installed = subprocess.run(
                [os.environ["RETRACE_CMAKE"], "--install", str(BUILD), "--prefix", str(prefix)],
                capture_output=True,
                text=True,
                timeout=300,
            )
            self.assertEqual(installed.returncode, 0, installed.stderr)
            moved = prefix.rename(prefix.with_name("there"))
            package = moved / "lib/python3/dist-packages"
            names = {file.name for file in (package / "retrace").iterdir()}
            self.assertLessEqual({"__init__.py", "files.py", "_core.pyi", "py.typed"}, names)
            code = (
                "import sys, retrace as rt\n"
                "print(rt.__file__, rt.rre(sys.argv[1]).rre.tolist())\n"
                "print([line.split()[-1] for line in open('/proc/self/maps') if 'libretrace' in line][0])\n"
            )
            ended = subprocess.run(
                [sys.executable, "-c", code, program.example("rtp_single_0p45mm.toml")],
                capture_output=True,
                text=True,
                timeout=60,
                env={"PYTHONPATH": str(package)},
                cwd=folder,
            )
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertEqual(ended.stdout.count(str(moved)), 2, ended.stdout)


if __name__ == "__main__":
    unittest.main()
