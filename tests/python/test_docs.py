"""Runs the Python code of the documentation, in the folder of the examples."""

import os
import pathlib
import re
import shutil
import tempfile
import unittest

import program


class Documents(unittest.TestCase):
    def run_page(self, page):
        text = (program.SOURCE / page).read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
        self.assertTrue(blocks, page)
        folder = os.getcwd()
        with tempfile.TemporaryDirectory() as copy:
            examples = pathlib.Path(copy, "examples")
            shutil.copytree(program.EXAMPLES, examples)
            os.chdir(examples)
            try:
                names = {}
                for number, block in enumerate(blocks, 1):
                    with self.subTest(page=page, block=number):
                        exec(compile(block, f"{page}, block {number}", "exec"), names)
            finally:
                os.chdir(folder)
        return names

    def test_python(self):
        names = self.run_page("docs/python.md")
        self.assertEqual(names["report"].verdict, "pass")

    def test_readme(self):
        self.run_page("README.md")


if __name__ == "__main__":
    unittest.main()
