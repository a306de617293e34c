"""Tests the page that `retrace report` writes, in a headless browser without a network.

    python3 browser_test.py RETRACE SOURCE [--keep]

--keep writes new screenshots into tests/data/pages instead of comparing the page with the old ones.
"""

import pathlib
import sys
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from browser import BrowserCase
from page_results import make_page, make_sheet_and_study

PROGRAM = SOURCE = None
WIDTH, HEIGHT = 1200, 1000


class PageCase(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.resize(WIDTH, HEIGHT)
        cls.page = make_page(PROGRAM, SOURCE, cls.folder.name)

    def setUp(self):
        self.load()

    def load(self):
        self.driver.get(self.page.as_uri())
        self.wait(lambda d: d.execute_script("return document.documentElement.dataset.ready") == "yes")

    def print_preview(self):
        """Shows the page as it is printed."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.driver.execute_script("dispatchEvent(new Event('beforeprint'))")

    def end_preview(self):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
        self.driver.execute_script("dispatchEvent(new Event('afterprint'))")


class PageWorks(PageCase):
    def test_structure(self):
        self.assertEqual(self.text("h1"), "Study of a prism")
        titles = self.texts("section > h2")
        for title in ("Summary", "In three dimensions", "Design", "Efficiency", "Footprint", "Far field", "Tool path",
                      "Verification", "Provenance"):
            self.assertIn(title, titles)
        for link in self.all("nav a"):
            self.assertTrue(self.all(link.get_attribute("href").split("#")[1].join(("#", ""))))
        for table in self.all("table[data-csv]"):
            self.assertTrue(table.find_element(By.CSS_SELECTOR, "caption").text)
            self.assertTrue(table.find_elements(By.CSS_SELECTOR, "th[scope=col]"))
        for image in self.all("img"):
            self.assertTrue(image.get_attribute("alt"))
            self.assertTrue(self.driver.execute_script("return arguments[0].naturalWidth", image) > 100)
        for drawing in self.all("figure.drawing svg"):
            self.assertTrue(drawing.get_attribute("aria-label"))
        self.assertGreater(len(self.all("svg .region")), 0)
        self.assertGreater(len(self.all("svg .spot")), 0)
        self.assertEqual(self.one("html").get_attribute("lang"), "en")

    def test_needs_no_network_and_is_small(self):
        self.assertEqual(self.driver.execute_script(
            "return performance.getEntriesByType('resource').map(e => e.name).filter(n => !/^(data|blob):/.test(n))"), [])
        pictures = sum(len(image.get_attribute("src")) for image in self.all("img"))
        self.assertLess(self.page.stat().st_size - pictures, 2.55e6)

    def test_curve_is_hovered_and_zoomed(self):
        figure = self.one("figure[data-chart]")
        over = figure.find_element(By.CSS_SELECTOR, ".u-over")
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", figure)
        ActionChains(self.driver).move_to_element(over).perform()
        at = self.wait(lambda d: figure.get_attribute("data-at"))
        incidence, rre = map(float, at.split())
        self.assertEqual(incidence, 0.0)  # the centre of the range from -40 to 40
        self.assertTrue(10 < rre <= 100)
        before = figure.get_attribute("data-zoom")
        ActionChains(self.driver).move_to_element_with_offset(over, -150, 0).click_and_hold() \
            .move_by_offset(300, 0).release().perform()
        self.wait(lambda d: figure.get_attribute("data-zoom") != before)
        low, high = map(float, figure.get_attribute("data-zoom").split())
        self.assertTrue(-40 < low < high < 40)

    def test_tool_path_is_zoomed_moved_and_sorted(self):
        figure = self.one("figure[data-path]")
        area = figure.find_element(By.CSS_SELECTOR, ".path")
        view = lambda: list(map(float, figure.get_attribute("data-view").split()))
        whole = view()
        self.assertTrue(whole[2] > 1.0)  # the width of the section: a prism of 1 mm and the motion to the next cut
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", area)
        area.send_keys("++")
        self.assertAlmostEqual(view()[2], 0.49 * whole[2], places=9)
        self.assertAlmostEqual(view()[3] / view()[2], whole[3] / whole[2], places=9)
        at = view()
        area.send_keys(Keys.ARROW_RIGHT)
        self.assertAlmostEqual(view()[0], at[0] + 0.15 * at[2], places=9)
        area.send_keys("0")
        self.assertEqual(view(), whole)
        kinds = figure.find_elements(By.CSS_SELECTOR, ".path-kinds label")
        self.assertIn("plunge", [kind.text for kind in kinds])
        kinds[0].click()
        first = figure.find_element(By.CSS_SELECTOR, ".path svg path")
        self.assertEqual(first.value_of_css_property("display"), "none")

    def test_curve_answers_to_the_keyboard(self):
        figure = self.one("figure[data-chart]")
        area = figure.find_element(By.CSS_SELECTOR, ".plot")
        area.send_keys(Keys.HOME)
        area.send_keys(Keys.ARROW_RIGHT)
        spoken = figure.find_element(By.CSS_SELECTOR, "[aria-live]")
        self.wait(lambda d: "-35" in spoken.get_attribute("textContent"))
        before = figure.get_attribute("data-zoom")
        area.send_keys("+")
        self.wait(lambda d: figure.get_attribute("data-zoom") != before)
        area.send_keys("0")
        self.wait(lambda d: figure.get_attribute("data-zoom") == before)

    def test_view_is_turned_and_paths_are_told(self):
        view = self.one("#scene")
        self.assertEqual(view.get_attribute("data-renderer"), "webgl")
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", view)
        before = view.get_attribute("data-camera")
        ActionChains(self.driver).move_to_element(view).click_and_hold().move_by_offset(120, 40).release().perform()
        self.wait(lambda d: view.get_attribute("data-camera") != before)
        before = view.get_attribute("data-camera")
        view.send_keys(Keys.ARROW_LEFT)
        self.wait(lambda d: view.get_attribute("data-camera") != before)
        steps = self.texts("#scene-steps li")
        self.assertTrue(steps[0].startswith("Enters the entrance face"))
        self.assertTrue(any(step.startswith("Total reflection at a facet") for step in steps))
        choices = self.all("#scene-paths input")
        self.assertGreater(len(choices), 2)
        choices[1].click()
        self.wait(lambda d: self.texts("#scene-steps li") != steps)

    def test_tables_are_saved_as_csv(self):
        target = self.downloads_to("saved")
        button = next(b for b in self.all("button.download") if "Ledger" in b.get_attribute("aria-label"))
        self.driver.execute_script("arguments[0].click()", button)
        file = target / "rre_ledger.csv"
        deadline = time.monotonic() + 60
        while not file.exists() and time.monotonic() < deadline:
            time.sleep(0.1)
        lines = file.read_text().splitlines()
        self.assertEqual(len(lines), 1 + 17)
        self.assertTrue(lines[0].startswith("design,incidence (deg),azimuth (deg)"))
        self.assertEqual(len(lines[1].split(",")), len(lines[0].split(",")))

    def test_light_and_dark(self):
        colours = self.check_themes()
        self.assertIn(self.background(), colours)
        self.paper(None)

    def test_prints(self):
        self.print_preview()
        self.assertFalse(self.one("nav").is_displayed())
        self.assertFalse(any(b.is_displayed() for b in self.all("button")))
        self.end_preview()
        pdf = self.driver.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})["data"]
        self.assertGreater(len(pdf), 20000)


# Size in pixels of a page of A4 without its margins.
PAPER_WIDTH, PAPER_HEIGHT = round((210 - 26) / 25.4 * 96), round((297 - 28) / 25.4 * 96)


class Study(PageCase):
    """Page with several designs, test points that fail, and the live section."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.page = make_sheet_and_study(PROGRAM, SOURCE, cls.folder.name)[1]

    def rectangles(self, selector):
        return self.driver.execute_script(
            "return [...document.querySelectorAll(arguments[0])].filter((e) => e.checkVisibility())"
            ".map((e) => e.getBoundingClientRect()).map(({left, right, height}) => [left, right, height])", selector)

    def test_fits_a_page_of_a4_in_light_colours(self):
        self.driver.execute_script("document.getElementById('theme').click()")  # dark
        self.assertEqual(self.one("html").get_attribute("data-theme"), "dark")
        self.resize(PAPER_WIDTH, PAPER_HEIGHT)
        self.print_preview()
        shown = self.driver.execute_script("return [getComputedStyle(document.documentElement).colorScheme, "
                                           "getComputedStyle(document.body).backgroundColor, getComputedStyle(document.body).color]")
        self.assertEqual(shown, ["light", "rgba(0, 0, 0, 0)", "rgb(28, 32, 38)"])
        self.assertFalse(self.one("#live").is_displayed())
        for selector in ("table", "figure", ".uplot", ".uplot canvas", ".scene-box", ".facts > div"):
            boxes = self.rectangles(selector)
            self.assertGreater(len(boxes), 0, selector)
            for left, right, height in boxes:
                self.assertGreaterEqual(left, -1, selector)
                self.assertLessEqual(right, PAPER_WIDTH + 1, selector)
                if selector != "table":
                    self.assertLess(height, PAPER_HEIGHT, selector)
        for selector in ("figure", ".scene-box", ".facts > div", "tr"):
            breaks = self.driver.execute_script("return [...new Set([...document.querySelectorAll(arguments[0])].map("
                                                "(e) => getComputedStyle(e).breakInside))]", selector)
            self.assertEqual(breaks, ["avoid"], selector)
        self.assertIn("rtp_single", self.text(".u-legend"))  # curves are named
        self.end_preview()
        self.resize(WIDTH, HEIGHT)

    def test_contents_stay_visible_and_follow_the_sections(self):
        self.resize(1400, HEIGHT)
        top = lambda: self.driver.execute_script("return document.querySelector('nav').getBoundingClientRect().top")
        self.assertGreater(top(), 0)
        link = next(a for a in self.all("nav a") if a.text.startswith("Photometry"))
        self.assertIn("bad", link.get_attribute("class"))
        link.click()
        self.wait(lambda d: self.texts("nav a[aria-current]") == [link.text])
        self.assertEqual(top(), 0)
        self.resize(WIDTH, HEIGHT)

    def test_failures_come_first_and_are_marked_by_more_than_colour(self):
        rows = self.driver.execute_script(
            "return [...document.querySelectorAll('table[data-csv$=\"photometry_points.csv\"] tbody tr')]"
            ".map((row) => [row.className, row.cells[0].textContent, getComputedStyle(row.cells[0], '::before').content])")
        failing = [row for row in rows if row[1] == "fail"]
        self.assertGreater(len(failing), 0)
        self.assertEqual(rows[:len(failing)], failing)
        for style, verdict, mark in rows:
            self.assertEqual(style == "bad", verdict == "fail")
            self.assertIn({"fail": "\u2717", "pass": "\u2713"}.get(verdict, "!"), mark)

    def test_cards_name_their_design(self):
        named = self.driver.execute_script("return [...document.querySelectorAll('.facts > div')].map("
                                           "(card) => [card.querySelector('dt').textContent, Boolean(card.querySelector('.subject'))])")
        self.assertEqual({name for name, is_named in named if not is_named}, {"Documents", "Warnings"})

    def test_looks_as_it_did(self):
        for width, height in ((1400, 1000), (390, 844)):
            for name in ("light", "dark"):
                self.resize(width, height)
                self.paper(name)
                self.driver.get("about:blank")
                self.load()
                self.driver.execute_script("document.documentElement.style.scrollBehavior = 'auto'")
                time.sleep(0.5)
                self.compare(f"report_{width}_{name}")
                self.driver.execute_script("document.querySelector('table[data-csv$=\"photometry_points.csv\"]').scrollIntoView()")
                time.sleep(0.5)
                self.compare(f"report_limits_{width}_{name}")
        self.paper(None)
        self.resize(WIDTH, HEIGHT)


class PageWithoutWebgl(PageCase):
    webgl = ("--disable-3d-apis",)

    def tearDown(self):
        pass  # three.js reports on the console that WebGL is missing

    def test_the_view_is_a_still_drawing(self):
        view = self.one("#scene")
        self.assertEqual(view.get_attribute("data-renderer"), "svg")
        self.assertGreater(len(self.all("#scene svg polygon")), 5)
        before = self.one("#scene svg").get_attribute("innerHTML")
        self.all("#scene-paths input")[1].click()
        self.wait(lambda d: self.one("#scene svg").get_attribute("innerHTML") != before)


if __name__ == "__main__":
    PROGRAM, SOURCE = sys.argv[1:3]
    BrowserCase.keep = "--keep" in sys.argv
    unittest.main(argv=sys.argv[:1])
