"""The checked-in bundle of the page is that of its sources: data/report_page against report/page/web.

    python3 bundle_test.py SOURCE
"""

import hashlib
import pathlib
import re
import sys
import unittest

SOURCE = None


def source_hash(folder):
    """As build.mjs has it."""
    files = ["build.mjs", "package.json", "package-lock.json", *(f"src/{f.name}" for f in (folder / "src").iterdir())]
    total = hashlib.sha256()
    for name in sorted(files):
        total.update(f"{name}\n".encode() + (folder / name).read_bytes())
    return total.hexdigest()


class Bundle(unittest.TestCase):
    def setUp(self):
        self.web = SOURCE / "report" / "page" / "web"
        self.data = SOURCE / "data" / "report_page"

    def test_is_fresh(self):
        wanted = source_hash(self.web)
        for name in ("page.js", "page.css"):
            found = re.match(r"/\* sources ([0-9a-f]{64}) ", (self.data / name).read_text())
            self.assertIsNotNone(found)
            self.assertEqual(found[1], wanted, f"{name} is stale: run tools/report_page")

    def test_carries_licences(self):
        text = (self.data / "LICENCES.txt").read_text()
        for name in ("three 0.", "uplot 1."):
            self.assertIn(name, text)
        self.assertGreaterEqual(text.count("Permission is hereby granted"), 2)

    def test_versions_are_pinned_without_a_host(self):
        lock = (self.web / "package-lock.json").read_text()
        self.assertNotIn("resolved", lock)
        self.assertNotRegex(lock, r"registry\.")
        for version in re.findall(r'"(?:three|uplot|esbuild)": "([^"]+)"', (self.web / "package.json").read_text()):
            self.assertRegex(version, r"^\d+\.\d+\.\d+$")

    def test_cannot_end_the_element_it_stands_in(self):
        self.assertNotIn("</script", (self.data / "page.js").read_text())
        self.assertNotIn("</style", (self.data / "page.css").read_text())


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
