"""Opens view.html and report.html in a real browser: what can be clicked, sorted, filtered, picked; nothing may be asked of the network.

    python3 -m venv venv && venv/bin/pip install playwright            # and a Chromium, or `venv/bin/playwright install chromium`
    straylight view systems/triplet/system.ron -o out/view.html
    straylight run systems/triplet/system.ron -o out --rays 2e5
    venv/bin/python tests/browser/check.py out/view.html out/report.html --shots out/shots [--chromium /usr/bin/chromium]

Exit code 0 if everything holds; every fault is a line.
"""

import argparse
import pathlib
import sys

from playwright.sync_api import sync_playwright

# Software rendering: a machine without a screen has WebGL 2 as well.
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SIZES = {"wide": (1400, 1000), "narrow": (400, 850)}
# Least standard deviation of the bytes of a picture that shows something.
LEAST_SPREAD = 4.0

faults = []


def require(holds, what):
    if not holds:
        faults.append(what)
        print("FAULT", what)


def spread(page, selector):
    """Standard deviation of the pixels of a canvas, 0..255; of its own drawing buffer, not of a screenshot."""
    return page.evaluate(
        """(selector) => {
            const canvas = document.querySelector(selector);
            const copy = Object.assign(document.createElement("canvas"), { width: 200, height: 150 });
            const context = copy.getContext("2d");
            context.drawImage(canvas, 0, 0, 200, 150);
            const bytes = context.getImageData(0, 0, 200, 150).data.filter((_, i) => i % 4 !== 3);
            const mean = bytes.reduce((a, b) => a + b, 0) / bytes.length;
            return Math.sqrt(bytes.reduce((a, b) => a + (b - mean) ** 2, 0) / bytes.length);
        }""",
        selector,
    )


def picture(page):
    return page.evaluate("document.getElementById('canvas').toDataURL()")


def settle(page):
    page.wait_for_timeout(350)


def look(page, name):
    """The 3-D view: it draws, turns, cuts, colours and answers."""
    page.locator("#canvas").scroll_into_view_if_needed()
    settle(page)
    require(spread(page, "#canvas") > LEAST_SPREAD, f"{name}: the canvas is empty")
    before = picture(page)
    page.locator("#canvas").focus()
    page.keyboard.press("ArrowLeft")
    settle(page)
    require(picture(page) != before, f"{name}: an arrow key does not turn the view")
    for way in ["coating", "medium", "side", "finish"]:
        page.select_option("#colour", way)
        settle(page)
        require(page.locator("#legend li").count() > 0, f"{name}: no legend for {way}")
    before = picture(page)
    page.select_option("#axis", "")
    settle(page)
    require(picture(page) != before, f"{name}: the section plane changes nothing")
    page.select_option("#axis", "0")
    page.check("#normals")
    settle(page)
    page.uncheck("#normals")
    page.click("[data-look=all]")
    page.click("#none")
    settle(page)
    page.click("#all")
    pick(page, name)
    parts = page.locator("#parts li").count()
    label = page.locator("#parts .name").last.inner_text()
    page.fill("#find", label)
    require(0 < page.locator("#parts li").count() <= parts, f"{name}: the list of parts does not filter")
    page.fill("#find", "")


def pick(page, name):
    """Clicks on a grid of places until a part answers."""
    page.locator("#canvas").scroll_into_view_if_needed()
    box = page.locator("#canvas").bounding_box()
    for i in range(1, 10):
        for k in range(1, 8):
            page.mouse.click(box["x"] + box["width"] * i / 10, box["y"] + box["height"] * k / 8)
            if page.locator("#picked b").count():
                require(" at (" in page.locator("#picked").inner_text(), f"{name}: a picked part has no place")
                return
    require(False, f"{name}: no click picks a part")


def tables(page, name):
    """Paths: sorted, filtered, chosen; a chosen one lights up."""
    table = page.locator("table.paths").first
    tools = table.locator("xpath=preceding-sibling::div[1]")
    keys = lambda key: [float(x) for x in table.locator("tbody[data-path]").evaluate_all(f"rows => rows.map(row => row.dataset.{key})")]
    for key in ["rays", "flux"]:
        table.locator(f"[data-sort={key}]").click()
        require(keys(key) == sorted(keys(key), reverse=True), f"{name}: not sorted by {key}")
    table.locator("[data-sort=flux]").click()
    require(keys("flux") == sorted(keys("flux")), f"{name}: the order does not turn")
    table.locator("[data-sort=flux]").click()
    tools.locator("[data-filter]").fill("scatter")
    shown = table.locator("tbody[data-path]:visible").count()
    require(0 < shown < table.locator("tbody[data-path]").count(), f"{name}: the filter keeps {shown} paths")
    tools.locator("[data-filter]").fill("")
    before = picture(page)
    row = table.locator("tbody[data-path]").first
    row.focus()
    page.keyboard.press("Enter")
    settle(page)
    require(row.get_attribute("aria-selected") == "true", f"{name}: Enter does not choose a path")
    require(picture(page) != before, f"{name}: a chosen path does not light up")
    require(spread(page, "#pathmap canvas") > LEAST_SPREAD, f"{name}: the light of a path is not drawn")


def maps(page, name):
    """A map answers to the pointer and to keys."""
    figure = page.locator("[data-map]").first
    figure.scroll_into_view_if_needed()
    box = figure.locator("image.pixels").bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    said = figure.locator(".readout").inner_text()
    require("held" in said and "W/m²" in said, f"{name}: the map reads {said!r}")
    require(figure.locator(".sections svg").count() == 2, f"{name}: no cross-sections")
    figure.focus()
    page.keyboard.press("ArrowUp")
    require(figure.locator(".readout").inner_text() != said, f"{name}: an arrow key does not move the pixel")


def fits(page, name):
    """Nothing sticks out of a narrow screen but tables that scroll by themselves."""
    wider = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    require(wider <= 1, f"{name}: {wider} px stick out to the right")


def check(browser, path, scheme, size, shots):
    name = f"{path.stem}-{size}-{scheme}"
    width, height = SIZES[size]
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
    page.on("console", lambda message: require(message.type not in ("error", "warning"), f"{name}: {message.text}"))
    page.on("pageerror", lambda error: require(False, f"{name}: {error}"))
    allowed = lambda url: url.startswith(("data:", "blob:")) or url == path.as_uri()
    page.on("request", lambda request: require(allowed(request.url), f"{name}: asks for {request.url[:120]}"))
    page.goto(path.as_uri())
    settle(page)
    page.screenshot(path=shots / f"{name}.png")
    fits(page, name)
    look(page, name)
    if page.locator("table.paths").count():
        tables(page, name)
        maps(page, name)
    page.screenshot(path=shots / f"{name}-whole.png", full_page=True)
    if size == "wide" and scheme == "light":
        page.emulate_media(media="print")
        page.pdf(path=shots / f"{name}.pdf", format="A4", print_background=True, prefer_css_page_size=True)
    page.close()


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("pages", nargs="+", type=pathlib.Path)
    arguments.add_argument("--shots", type=pathlib.Path, default=pathlib.Path("shots"))
    arguments.add_argument("--chromium", help="browser to use instead of Playwright's own")
    asked = arguments.parse_args()
    asked.shots.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=asked.chromium, args=FLAGS)
        for path in asked.pages:
            for size in SIZES:
                for scheme in ["light", "dark"]:
                    check(browser, path.resolve(), scheme, size, asked.shots)
        browser.close()
    print(f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
