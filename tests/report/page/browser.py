"""Headless browser without a network, and functions for tests of pages."""

import os
import pathlib
import tempfile
import unittest

from PIL import Image, ImageChops, ImageFilter
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

# Screenshots are stored in grey and reduced by this factor, so that they are small and letters of other fonts hardly
# differ.
REDUCTION = 4
BLUR_PX = 1  # of reduced pictures
DIFFERENT = 24  # minimum difference of pixels that counts, from 0 to 255, after blurring
MAX_DIFFERENT_FRACTION = 0.02  # maximum fraction of pixels that may differ
PICTURES = pathlib.Path(__file__).resolve().parents[2] / "data" / "pages"  # stored screenshots
# Settings of Chromium without a graphics card: WebGL and compositing run on the processor.
SOFTWARE_WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing")


def browser(profile, *more):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--force-device-scale-factor=1",
                     "--hide-scrollbars", "--font-render-hinting=none", "--disable-lcd-text",
                     "--disable-background-networking", "--no-first-run", "--disable-dev-shm-usage",
                     f"--user-data-dir={profile}", *more):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_page_load_timeout(120)
    return driver


def reduced(picture):
    grey = picture.convert("L")
    return grey.resize((grey.width // REDUCTION, grey.height // REDUCTION), Image.Resampling.BOX)


def fraction_that_differs(picture, wanted):
    """Returns the fraction of pixels that differ after both pictures are blurred."""
    blurred = [p.filter(ImageFilter.GaussianBlur(BLUR_PX)) for p in (picture, wanted)]
    difference = ImageChops.difference(*blurred).point(lambda v: 255 if v > DIFFERENT else 0)
    return difference.histogram()[255] / (picture.size[0] * picture.size[1])


class BrowserCase(unittest.TestCase):
    """Base class of tests with a browser. Each test class has its own folder and browser. A test fails if the console
    shows errors."""

    webgl = SOFTWARE_WEBGL
    keep = False  # True: write new screenshots instead of comparing with the old ones

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        cls.addClassCleanup(cls.folder.cleanup)
        cls.driver = browser(os.path.join(cls.folder.name, "profile"), *cls.webgl)
        cls.addClassCleanup(cls.driver.quit)

    @classmethod
    def resize(cls, width, height):
        """Sets the size of the page itself. The size of a window would include its border."""
        cls.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                   {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def paper(self, name):
        """Sets the preference of the system for a light or dark theme. None removes the preference."""
        features = [{"name": "prefers-color-scheme", "value": name}] if name else []
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})

    def background(self):
        return self.driver.execute_script("return getComputedStyle(document.body).backgroundColor")

    def check_themes(self):
        """Checks that the light and the dark theme differ, and that the button changes from dark to light. Returns the
        background colours of both themes."""
        colours = set()
        for name in ("light", "dark"):
            self.paper(name)
            colours.add(self.background())
        self.assertEqual(len(colours), 2)
        self.one("#theme").click()
        self.assertEqual(self.one("html").get_attribute("data-theme"), "light")
        return colours

    def wait(self, condition):
        return WebDriverWait(self.driver, 180, poll_frequency=0.1).until(condition)

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def texts(self, selector):
        """Returns the texts of all matching elements. They are read in one call, because the page may redraw the
        elements between two calls."""
        return self.driver.execute_script(
            "return [...document.querySelectorAll(arguments[0])].map(e => e.innerText.trim())", selector)

    def text(self, selector):
        return self.texts(selector)[0]

    def downloads_to(self, name):
        """Returns a new folder with this name, to which the page saves its files."""
        target = pathlib.Path(self.folder.name) / name
        target.mkdir(exist_ok=True)
        self.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(target)})
        return target

    def compare(self, name):
        """Compares a screenshot of the page with the stored picture of this name. A missing picture is an error."""
        file = PICTURES / f"{name}.png"
        taken = pathlib.Path(self.folder.name) / file.name
        self.driver.save_screenshot(str(taken))
        picture = reduced(Image.open(taken))
        if self.keep:
            file.parent.mkdir(exist_ok=True)
            picture.quantize(64).save(file, optimize=True)
            return
        wanted = Image.open(file).convert("L")
        self.assertEqual(picture.size, wanted.size)
        fraction = fraction_that_differs(picture, wanted)
        self.assertLess(fraction, MAX_DIFFERENT_FRACTION, f"{file.name}: {fraction:.1%} of the pixels differ")

    def tearDown(self):
        faults = [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(faults, [], "the console has errors")
