"""The page of pbnbrdf report in Chromium: nothing is asked of the net, nothing fails, and what it shows is what
the library says.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import time

from common import SKIP, check, path, program, require

api, = require("playwright.sync_api")
CHROMIUM = shutil.which("chromium")
if not CHROMIUM:
    print("skipped: needs chromium, which ./do peers installs")
    sys.exit(SKIP)

SOFTWARE_WEBGL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NO_WEBGL = ["--disable-3d-apis"]
SMALL = ["--film_width=64", "--samples_per_pixel=4", "--quiet"]
QUICK = ["--samples=2000", "--max_iterations=60", "--quiet"]


def make_pages():
    """(of one fit, of several)"""
    program("fit", "--material=builtin:satin-gold;builtin:plastic-laminate;builtin:spectralon",
            f"--out_dir={path('fits')}", *QUICK)
    program("report", f"--fits={path('fits')}", f"--out={path('fits.html')}", *SMALL)
    program("report", f"--fit={path('fits/satin-gold.safetensors')}", f"--out={path('gold.html')}", *SMALL)
    return path("gold.html"), path("fits.html")


class Page:
    """A page that is open; what goes wrong in it, and what it asks for, is kept."""

    def __init__(self, chromium, file, **options):
        self.faults, self.requests = [], []
        self.context = chromium.new_context(**options)
        page = self.page = self.context.new_page()
        page.on("console", lambda message: self.faults.append(message.text)
                if message.type in ("error", "warning") else None)
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))
        self.url = "file://" + os.path.abspath(file)
        page.goto(self.url)

    def close(self):
        asked = [url for url in self.requests if url != self.url and not url.startswith(("data:", "blob:"))]
        assert not asked, asked
        faults = [text for text in self.faults if "GPU stall" not in text]  # of reading pixels for this test
        assert not faults, faults
        self.context.close()

    def drawn(self):
        """Waits until the sphere is, as the light and the view now are."""
        self.page.wait_for_function("""() => {
          const {light, view} = document.getElementById('sphere').dataset;
          return light === direction(sphere.light).join(' ') && view === direction(sphere.view).join(' ');
        }""")

    def pixel(self, x, y):
        """Of the sphere's canvas, as parts of its width and height; 0 to 255."""
        return self.page.evaluate("""([x, y]) => {
          const from = document.getElementById('sphere'), to = document.createElement('canvas');
          [to.width, to.height] = [from.width, from.height];
          const context = to.getContext('2d');
          context.drawImage(from, 0, 0);
          return [...context.getImageData(Math.floor(x * to.width), Math.floor(y * to.height), 1, 1).data].slice(0, 3);
        }""", [x, y])


def srgb(linear):
    c = min(max(linear, 0.0), 1.0)
    return 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055


def library_value(source, wi, wo):
    rows = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n" + ",".join(map(repr, [*wi, *wo])) + "\n"
    done = subprocess.run([sys.argv[1], "eval", f"--material={source}", "--directions=-", "--out=-"], input=rows,
                          capture_output=True, text=True, check=True)
    names, values = [line.split(",") for line in done.stdout.strip().splitlines()[-2:]]
    row = dict(zip(names, values))
    return [float(row[channel]) for channel in "rgb"]


def check_sphere(chromium, file):
    """The middle of each picture, where the normal points to the viewer, for two positions of the light."""
    opened = Page(chromium, file)
    page = opened.page
    first = None
    for presses in (0, 3):
        page.focus("#sphere")
        for _ in range(presses):
            page.keyboard.press("ArrowRight")
        opened.drawn()
        light = [float(x) for x in page.get_attribute("#sphere", "data-light").split()]
        assert light != first
        first = light
        # The frame at the middle: x is east, which is +x there, y is up.
        for what, source, x, limit in (("fit", path("fits/satin-gold.safetensors"), 0.75, 1.0),
                                       ("material's table", "builtin:satin-gold", 0.25, 4.0)):
            value = library_value(source, light, [0.0, 0.0, 1.0])
            expected = [255 * srgb(math.pi * v * light[2]) for v in value]
            assert 8 < max(expected) < 250, expected  # the comparison can fail
            check(f"{what}, middle of the sphere, light {light}",
                  max(abs(a - b) for a, b in zip(opened.pixel(x, 0.5), expected)), limit)
    for choice in ("torus", "environment"):
        before = opened.pixel(0.75, 0.4)
        page.check(f"input[value={choice}]")
        deadline = time.monotonic() + 120  # software draws many lights in seconds
        while opened.pixel(0.75, 0.4) == before:
            assert time.monotonic() < deadline, choice
            page.wait_for_timeout(200)
    opened.close()


def check_divider(chromium, file):
    opened = Page(chromium, file)
    page = opened.page
    at = lambda: float(page.evaluate("document.getElementById('divider').style.getPropertyValue('--at')")[:-1])
    page.focus("#divide")
    page.keyboard.press("ArrowRight")
    assert at() == 50.5, at()
    box = page.locator("#divider").bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.5 * box["height"], steps=4)
    page.mouse.up()
    assert abs(at() - 20) < 2, at()
    opened.close()


def check_table(chromium, file):
    opened = Page(chromium, file)
    page = opened.page
    names = lambda: page.locator("#fits tbody tr td:first-child").all_inner_texts()
    assert names() == ["plastic-laminate", "satin-gold", "spectralon"], names()
    page.focus("#fits th:first-child button")
    page.keyboard.press("Enter")
    assert names() == ["spectralon", "satin-gold", "plastic-laminate"], names()
    errors = {m["name"]: m["measures"][0]["value"] for m in
              json.loads(page.locator("#report-data").text_content())["materials"]}
    page.click("#fits th:nth-child(2) button")
    assert names() == sorted(errors, key=errors.get), (names(), errors)
    page.fill("#filter", "GOLD")
    assert names() == ["satin-gold"], names()
    page.fill("#filter", "")
    page.click("#fits tbody tr:last-child button")
    assert page.inner_text("#name") == names()[-1]
    opened.drawn()
    opened.close()


def check_looks(chromium, file):
    """Nothing is wider than a phone, all plots are drawn, and the colours follow the scheme."""
    brightness = {}
    for scheme in ("light", "dark"):
        opened = Page(chromium, file, color_scheme=scheme, viewport={"width": 400, "height": 800})
        page = opened.page
        opened.drawn()
        assert page.evaluate("document.documentElement.scrollWidth") <= 400
        for plot in ("plane", "polar", "half", "albedo", "history"):
            inked = page.evaluate("""id => {
              const canvas = document.getElementById(id);
              const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
              return data.filter((value, n) => n % 4 === 3 && value > 0).length / (canvas.width * canvas.height);
            }""", f"plot-{plot}")
            assert inked > 0.01, (plot, inked)
        page.screenshot(path=path(f"{scheme}.png"), full_page=True)
        colour = page.evaluate("getComputedStyle(document.body).backgroundColor")
        brightness[scheme] = sum(int(c) for c in colour[4:-1].split(","))
        opened.close()
    assert brightness["light"] > 600 and brightness["dark"] < 150, brightness


def check_without_webgl(launch, file):
    with launch(NO_WEBGL) as chromium:
        opened = Page(chromium, file)
        assert "WebGL 2" in opened.page.inner_text("#no-sphere")
        assert not opened.page.is_visible("#interactive")
        assert opened.page.is_visible("#plot-plane")
        opened.faults = [text for text in opened.faults if "WebGL" not in text]  # Chromium's own words
        opened.close()


def main():
    one, several = make_pages()
    with api.sync_playwright() as playwright:
        launch = lambda flags: playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *flags])
        with launch(SOFTWARE_WEBGL) as chromium:
            check_sphere(chromium, one)
            check_divider(chromium, one)
            check_table(chromium, several)
            check_looks(chromium, one)
        check_without_webgl(launch, one)


main()
