"""Tests that blocks of the report, the set-up sheet and the live page do not overlap and are not cut off, on wide and
narrow screens, in light and dark mode.

    python3 layout_test.py RETRACE SOURCE
    python3 layout_test.py --site FOLDER    every page of the site that tools/site has built in FOLDER
"""

import pathlib
import sys
import unittest

from browser import BrowserCase
from layout import WIDTHS, cuts, leaks, overlaps
from page_results import make_sheet_and_study, run

PROGRAM = SOURCE = SITE = None
HEIGHT = 1000
VIEWS = [(width, theme) for width in WIDTHS for theme in (("light",) if width == 800 else ("light", "dark"))]
BLOCKS = """<!DOCTYPE html><meta charset="utf-8">
<style>p {{ margin: 0; height: 2rem }} img {{ height: 4rem; width: 9rem }} figure {{ margin: 0 }} #box {{ position: relative }} {} </style>
<div id="box"><p>first</p><p id="second">second</p></div>
<figure><img alt="picture" src="data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg'/>"></figure><p>third</p>"""


class LayoutCase(BrowserCase):
    def load(self, page, ready="document.readyState === 'complete'"):
        self.driver.get("about:blank")
        self.driver.get(page.as_uri())
        self.wait(lambda d: d.execute_script(f"return {ready}"))
        self.driver.execute_async_script("document.fonts.ready.then(arguments[0])")

    def settle(self):
        """Waits until the page has been drawn for the new size of the window."""
        self.driver.execute_async_script("setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(arguments[0])), 300)")

    def check(self, name, least_items, views=VIEWS, may_be_cut=False):
        """Checks the loaded page with the widths and themes of `views`.

        \\param may_be_cut true if boxes of the page may be scrolled
        """
        self.driver.execute_script("for (const e of document.querySelectorAll('details')) e.open = true")
        for width, theme in views:
            with self.subTest(page=name, width=width, theme=theme):
                self.resize(width, HEIGHT)
                self.paper(theme)
                self.settle()
                items, faults = overlaps(self.driver)
                self.assertGreaterEqual(items, least_items)
                self.assertEqual(faults, [])
                if not may_be_cut:
                    self.assertEqual(cuts(self.driver), [])
                self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), width)


class Measure(LayoutCase):
    def faults(self, style):
        page = pathlib.Path(self.folder.name) / "blocks.html"
        page.write_text(BLOCKS.format(style))
        self.load(page)
        return overlaps(self.driver)[1]

    def test_blocks_that_overlap_are_found(self):
        self.assertEqual(self.faults(""), [])
        for style in ("#second { margin-top: -1rem }", "figure { height: 1rem }", "p { height: .3rem }",
                      "#second { transform: translateY(-1rem) }", "#box { height: 2rem }",
                      "#second { position: absolute; top: 60px }"):
            self.assertNotEqual(self.faults(style), [], style)

    def test_contents_that_are_cut_off_are_found(self):
        page = pathlib.Path(self.folder.name) / "cut.html"
        for style, is_cut in (("", False), ("#box { overflow: hidden; width: 1rem }", True),
                              ("#box { overflow-x: auto; width: 1rem }", True),
                              ("#box { overflow: hidden; width: 1rem; text-overflow: ellipsis }", False)):
            page.write_text(BLOCKS.format(style))
            self.load(page)
            self.assertEqual(bool(cuts(self.driver)), is_cut, style)
        page.write_text('<div class="table-box" style="height: 1rem; overflow-y: auto"><table><tr><td>pass<tr class="bad">'
                        '<td>fail</table></div>')
        self.load(page)
        self.assertEqual(len(cuts(self.driver)), 1)

    def test_what_is_hidden_or_a_layer_of_its_container_is_none(self):
        for style in ("#second { position: absolute; top: 0 }", "#second { margin-top: -1rem; visibility: hidden }",
                      "#second { margin-top: -1rem; opacity: 0 }", "figure { height: 1rem; overflow: hidden }"):
            self.assertEqual(self.faults(style), [], style)


class Pages(LayoutCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.sheet, cls.report = make_sheet_and_study(PROGRAM, SOURCE, cls.folder.name)
        cls.live = pathlib.Path(cls.folder.name) / "live.html"
        run(PROGRAM, "explore", "-o", cls.live, "--quiet")

    def load_report(self):
        self.load(self.report, "document.documentElement.dataset.ready === 'yes' && "
                               "document.getElementById('live').dataset.ready === 'yes'")

    def test_report(self):
        self.load_report()
        self.check("report", 1000)

    def test_set_up_sheet(self):
        self.load(self.sheet)
        self.check("set-up sheet", 500, may_be_cut=True)  # for paper: on narrow screens its tables are scrolled

    def test_live_page(self):
        for tab in ("form", "text"):
            self.load(self.live, "document.getElementById('live').dataset.ready === 'yes'")
            self.driver.execute_script("const s = document.querySelector('.programme select'); s.value = 'r150'; "
                                       "s.dispatchEvent(new Event('change'))")
            self.wait(lambda d: self.all(".test tbody tr"))
            next(b for b in self.all("button") if b.text == "Pin").click()
            self.driver.execute_script(f"document.getElementById('live-tab-{tab}').click()")
            self.check(f"live page, {tab}", 300)

    def test_styles_of_the_live_section_reach_nothing_else_of_a_report(self):
        self.load_report()
        self.assertEqual(leaks(self.driver, (SOURCE / "data/report_page/page.css").read_text()), [])


class Site(LayoutCase):
    def test_pages(self):
        pages = sorted(page for page in SITE.rglob("*.html") if page.name != "404.html")
        self.assertGreater(len(pages), 20)
        for page in pages:
            self.load(page)
            self.check(str(page.relative_to(SITE)), 5, views=[(width, "light") for width in WIDTHS], may_be_cut=True)


if __name__ == "__main__":
    if sys.argv[1] == "--site":
        SITE = pathlib.Path(sys.argv[2]).resolve()
    else:
        PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=[sys.argv[0], *(("Measure", "Pages") if SITE is None else ("Site",))])
