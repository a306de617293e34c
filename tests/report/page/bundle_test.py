"""Tests that the checked-in bundles of the pages are up to date: data/report_page with the sources in report/page/web,
and data/live_page with the sources in live/web and the shared sources in report/page/web.

    python3 bundle_test.py SOURCE
"""

import hashlib
import pathlib
import re
import sys
import unittest

SOURCE = None


def files_of(folder):
    return [file for file in folder.rglob("*") if file.is_file()]


def source_hash(names):
    """Returns the hash of source files, computed in the same way as in both build.mjs.

    \\param names dictionary from the name of a file in the hash to the path of the file
    """
    total = hashlib.sha256()
    for name, file in sorted(names.items()):
        total.update(f"{name}\n".encode() + file.read_bytes())
    return total.hexdigest()


class Bundle(unittest.TestCase):
    def setUp(self):
        self.web = SOURCE / "report" / "page" / "web"
        self.data = SOURCE / "data" / "report_page"

    def sources(self):
        names = ["build.mjs", "package.json", "package-lock.json", *(f"src/{f.name}" for f in (self.web / "src").iterdir())]
        return {name: self.web / name for name in names}

    def test_is_fresh(self):
        wanted = source_hash(self.sources())
        for name in ("page.js", "page.css"):
            found = re.match(r"/\* sources ([0-9a-f]{64}) .* made by (tools/\w+)", (self.data / name).read_text())
            self.assertIsNotNone(found)
            self.assertEqual(found[1], wanted, f"{name} is stale: run {found[2]}")

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


class LiveBundle(Bundle):
    def setUp(self):
        super().setUp()
        self.data = SOURCE / "data" / "live_page"

    def sources(self):
        live = SOURCE / "live" / "web"
        files = [live / "build.mjs", *files_of(live / "src"), self.web / "package.json", self.web / "package-lock.json",
                 *files_of(self.web / "src")]
        return {file.relative_to(SOURCE).as_posix(): file for file in files}


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
