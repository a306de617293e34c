"""Executes the notebooks of examples/."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import program

NOTEBOOKS = sorted((program.EXAMPLES / "notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_they_are_kept_without_outputs(self):
        self.assertEqual(len(NOTEBOOKS), 4)
        for notebook in NOTEBOOKS:
            cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
            with self.subTest(notebook=notebook.name):
                self.assertFalse(
                    [cell for cell in cells if cell.get("outputs") or cell.get("execution_count")]
                )

    def test_they_run(self):
        # One process executes all notebooks, because it takes a second to start.
        with tempfile.TemporaryDirectory() as folder:
            # The files of the kernel are also written to this folder.
            environment = {
                **os.environ,
                "HOME": folder,
                "JUPYTER_RUNTIME_DIR": folder,
                "IPYTHONDIR": folder,
                "PYDEVD_DISABLE_FILE_VALIDATION": "1",
            }
            ended = subprocess.run(
                [
                    sys.executable,
                    "-m",
                    "nbconvert",
                    "--to",
                    "notebook",
                    "--execute",
                    "--output-dir",
                    folder,
                    "--ExecutePreprocessor.timeout=300",
                    *map(str, NOTEBOOKS),
                ],
                capture_output=True,
                text=True,
                env=environment,
                cwd=NOTEBOOKS[0].parent,
                timeout=1000,
            )
            self.assertEqual(ended.returncode, 0, ended.stderr[-3000:])
            for notebook in NOTEBOOKS:
                with self.subTest(notebook=notebook.name):
                    text = pathlib.Path(folder, notebook.name).read_text(encoding="utf-8")
                    drawn = [
                        output
                        for cell in json.loads(text)["cells"]
                        for output in cell.get("outputs", ())
                        if "image/svg+xml" in output.get("data", ())
                        or "text/html" in output.get("data", ())
                    ]
                    self.assertGreaterEqual(len(drawn), 2)


if __name__ == "__main__":
    unittest.main()
