#!/usr/bin/env python3
"""Opens pages of `asperity report` in Chromium, uses them by mouse and keys, and takes pictures of them.

    web/tests/report.py BROWSER PAGE...

The browser has no window and no network. Exits with 1 and the complaints if a page is not as it should be.
"""

import pathlib
import sys

from browser import Browser

WIDTHS = {"wide": 1300, "narrow": 400}
# the maps, the least number of charts, and the warnings of the pages of some folders, of other folders, and of tables
FOLDERS, FOLDER, TABLE = {"leaked": (2, 0, 0), "contact": (0, 4, 0)}, (3, 1, 1), (0, 2, 1)

# what only a browser can tell of a page
STATE = """(async () => {
  const all = selector => [...document.querySelectorAll(selector)];
  const pixels = async image => {
    const copy = new Image();
    copy.src = image.href.baseVal;
    await copy.decode().catch(() => {});
    return copy.naturalWidth * copy.naturalHeight;
  };
  return {
    title: document.title,
    heading: document.querySelector("h1").textContent,
    text: document.body.innerText,
    pixels: await Promise.all(all("image").map(pixels)),
    maps: all("figure.map").length,
    charts: all("figure.chart").length,
    warnings: all(".warnings li").length,
    widths: all("figure svg").map(svg => svg.getBoundingClientRect().width),
    beyond: document.documentElement.scrollWidth - innerWidth,
  };
})()"""

ZOOMED = 'document.querySelectorAll("figure.map")[%d].classList.contains("zoomed")'

# of a map the part that is shown, the middles of its buttons on the screen, a point on it, and what is there
MAP = """(() => {
  const figure = document.querySelectorAll("figure.map")[%d], svg = figure.querySelector("svg");
  const { x, y, width, height } = svg.getBoundingClientRect(), screen = [x + width / 3, y + height / 4];
  const middle = box => [box.x + box.width / 2, box.y + box.height / 2];
  const point = new DOMPoint(...screen).matrixTransform(svg.getScreenCTM().inverse());
  return {
    view: svg.getAttribute("viewBox").split(" ").map(Number),
    buttons: Object.fromEntries(
      [...figure.querySelectorAll("button")].map(button => [button.title, middle(button.getBoundingClientRect())])),
    screen, point: [point.x, point.y], unit: svg.getScreenCTM().a, scrolled: scrollY,
  };
})()"""

# what a map says of the place under the pointer, and of its scale
READ = """(() => {
  const figure = document.querySelectorAll("figure.map")[%d];
  return { value: figure.querySelector("output").textContent, bar: figure.querySelector(".scale").innerText };
})()"""


def near(some, others):
    """Whether all numbers are the same to a thousandth of the largest: places on a screen are whole pixels."""
    most = max(map(abs, [*some, *others, 1e-3]))
    return all(abs(a - b) < 2e-3 * most for a, b in zip(some, others, strict=True))


def check_map(browser, number, told):
    """Uses all that zooms and moves a map."""
    browser.value(f'document.querySelectorAll("figure.map")[{number}].scrollIntoView(), 0')

    def now():
        return browser.value(MAP % number)

    start = now()
    names, whole = list(start["buttons"]), start["view"]
    if names != ["zoom in", "zoom out", "show all"]:
        return told(False, f"has the buttons {names}")

    def shown(what, share):
        view = now()["view"]
        told(near(view[2:], [share * side for side in whole[2:]]), f"{what}: {view} of {whole} is shown")

    browser.mouse("mouseMoved", start["screen"])
    told(browser.comes_true(f"({READ % number}).value"), "reads nothing under the pointer")
    browser.click(start["buttons"]["zoom in"])
    shown("zoom in", 1 / 1.5)
    told(browser.value(f"({READ % number}).bar").endswith("m"), "has no scale bar")
    browser.key("+")
    shown("the key +", 1 / 1.5**2)
    browser.click(start["buttons"]["zoom out"])
    shown("zoom out", 1 / 1.5)
    before = now()
    by = [30, -20]
    browser.drag(before["screen"], by)
    after = now()
    dragged = [place - way / after["unit"] for place, way in zip(before["point"], by)]
    told(near(after["point"], dragged), "is not dragged by the mouse")
    browser.click(start["screen"], 2)
    told(now()["view"] == whole, "a double click does not show all")
    browser.wheel(start["screen"], -100)
    told(browser.comes_true(f"scrollY != {start['scrolled']} || {ZOOMED % number}"), "the wheel does nothing")
    shown("the wheel", 0.8)
    told(near(now()["point"], start["point"]), "the wheel moves what is under the pointer away from it")
    told(now()["scrolled"] == start["scrolled"], "the wheel scrolls where it zooms")
    browser.click(start["buttons"]["show all"])
    told(now()["view"] == whole, "the button does not show all")
    browser.wheel(start["screen"], 100)
    scrolled = browser.comes_true(f"scrollY > {start['scrolled']}")
    told(scrolled, "the wheel does not scroll where there is nothing to zoom out")


def check(browser, path):
    """The complaints about a page."""
    complaints = []

    def told(holds, what):
        if not holds:
            complaints.append(f"{path}: {what}")

    url = path.absolute().as_uri()
    for name, width in WIDTHS.items():
        browser("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        browser.where = f"{path}: {name}"
        browser.open(url)
        state = browser.value(STATE)
        folder = path.name == "report.html"
        maps, charts, warnings = FOLDERS.get(path.parent.name, FOLDER) if folder else TABLE
        told(state["title"] == state["heading"] == (path.parent.name if folder else path.stem), f"is {state['title']}")
        told(state["maps"] == maps, f"has {state['maps']} maps")
        told(len(state["pixels"]) >= state["maps"], f"has {len(state['pixels'])} images")
        told(all(pixels >= 64 for pixels in state["pixels"]), f"has images of {state['pixels']} pixels")
        told(state["charts"] >= charts, f"has {state['charts']} charts")
        told(state["warnings"] == warnings, f"has {state['warnings']} warnings")
        told(all(0.75 * min(width, 600) < svg < width for svg in state["widths"]), f"{name}: {state['widths']} wide")
        told(state["beyond"] <= 0, f"{name}: {state['beyond']} pixels wider than the window")
        told(("asperity run repeats" in state["text"] or path.name == "study.csv.html") and "How to cite" in state["text"], "ends early")
        for number in range(state["maps"]):
            check_map(browser, number, lambda holds, what: told(holds, f"{name}, map {number}: {what}"))
        browser.picture(path.with_suffix(f".{name}.png"))
        for event in browser.events:
            params = event["params"]
            match event["method"]:
                case "Runtime.exceptionThrown" | "Log.entryAdded" | "Runtime.consoleAPICalled":
                    told(False, f"{name}: {params}")
                case "Network.requestWillBeSent":
                    asked = params["request"]["url"]
                    told(asked == url or asked.startswith("data:"), f"asks for {asked:.100}")
    return complaints


def main():
    browser = Browser(sys.argv[1])
    pages = [pathlib.Path(page) for page in sys.argv[2:]]
    complaints = [complaint for page in pages for complaint in check(browser, page)]
    browser.close()
    if complaints:
        sys.exit("\n".join(complaints))
    print(f"{len(pages)} pages opened, all as they should be")


main()
