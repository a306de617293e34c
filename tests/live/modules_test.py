"""Tests that no module of the pages imports itself, directly or through other modules.

    python3 modules_test.py SOURCE
"""

import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else ".").resolve()
FOLDERS = ("live/web/src", "report/page/web/src")


def imported(module):
    """Returns the modules that a module imports by a relative path."""
    paths = re.findall(r'^(?:import|export)\b[^;"]*"(\.[^"]+\.js)"', module.read_text(), re.MULTILINE)
    return [(module.parent / path).resolve() for path in paths]


def circle(imports):
    """Returns the modules of a circle of imports, or an empty list. The first module is repeated at the end.

    \\param imports for each module, the modules that it imports
    """
    finished = set()

    def search(path):
        module = path[-1]
        if module in path[:-1]:
            return path[path.index(module) :]
        for other in [] if module in finished else imports[module]:
            if found := search([*path, other]):
                return found
        finished.add(module)
        return []

    return next(filter(None, (search([module]) for module in imports)), [])


class Modules(unittest.TestCase):
    def test_circles_are_found(self):
        self.assertEqual(circle({"a": ["b", "c"], "b": ["c"], "c": []}), [])
        self.assertEqual(circle({"a": ["b"], "b": ["c"], "c": ["b"]}), ["b", "c", "b"])
        self.assertEqual(circle({"a": ["a"]}), ["a", "a"])

    def test_modules_have_no_circle(self):
        files = [file for folder in FOLDERS for file in sorted((SOURCE / folder).rglob("*.js"))]
        imports = {file: imported(file) for file in files}
        self.assertGreater(sum(map(len, imports.values())), 50)
        self.assertEqual([str(file.relative_to(SOURCE)) for file in circle(imports)], [])


if __name__ == "__main__":
    unittest.main()
