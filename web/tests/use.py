#!/usr/bin/env python3
"""Opens the page of the browser in Chromium, uses it as people do, and compares its answers with those of the program.

    web/tests/use.py BROWSER TOOL SITE

The page is served from the folder SITE by a host that is away once the page has loaded. Exits with 1 and the complaints
if something is not as it should be. Pictures are in target/web-pictures.
"""

import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from browser import Browser
from host import ALL, Host
from page import IDLE, SET, WINDOWS, Page

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURES = ROOT / "target" / "web-pictures"

# the colours on the map of the contact: black nodes, and nodes of all
PAINTED = """(() => {
  const canvas = document.querySelector("#maps canvas"), { width, height } = canvas;
  const pixels = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, width, height).data.buffer);
  return [pixels.filter(pixel => pixel === 0xff000000).length, width * height];
})()"""


def share(state):
    """The contact fraction in per cent."""
    return float(state["rows"]["contact"].split()[0])


def check_first_view(page):
    """The page shows contact at once, and says how it was found."""
    state = page.state()
    page.told(0 < share(state) < 100, f"first shows a contact of {state['rows'].get('contact')}")
    black, all_nodes = page.browser.value(PAINTED)
    page.told(
        (black, all_nodes) == (int(state["rows"]["nodes in contact"].split()[0]), 256**2),
        f"paints {black} of {all_nodes} nodes",
    )
    page.told(state["rows"]["status"] == "converged", "has not converged at first")
    page.told(
        all(count for name, count in state["charts"].items() if name != "loop"), f"has the charts {state['charts']}"
    )
    nameless = page.browser.value(
        """[...document.querySelectorAll("input, select, button")]
      .filter(input => !input.labels?.length && !input.ariaLabel && !input.textContent).map(input => input.outerHTML)"""
    )
    page.told(not nameless, f"has inputs without a label: {nameless}")
    return state["solves"][0]


def check_drag(page):
    """The contact follows the load, by mouse and by keys, and the last load of a drag is the one that is solved."""
    before = page.state()
    at = page.place("#drag", 0.5)
    width = page.browser.value("document.getElementById('drag').getBoundingClientRect().width")
    page.browser.mouse("mousePressed", at, button="left", clickCount=1)
    for step in range(1, 31):
        page.browser.mouse("mouseMoved", [at[0] + 0.01 * step * width, at[1]], button="left", buttons=1)
    page.browser.mouse("mouseReleased", [at[0] + 0.3 * width, at[1]], button="left", clickCount=1)
    after = page.idle("a drag by the mouse")
    page.told(share(after) > 1.5 * share(before), f"dragged from {share(before)} % to {share(after)} %")
    page.told(
        after["load"] != before["load"] and f"at {after['load']}:" in after["status"],
        f"{after['status']} after the load {after['load']}",
    )
    solves = len(after["solves"]) - len(before["solves"])
    page.told(1 <= solves <= 31, f"has solved {solves} of the 31 loads of a drag")
    page.browser.value("document.getElementById('drag').focus()")
    page.browser.key("ArrowLeft")
    keyed = page.idle("an arrow key")
    page.told(share(keyed) < share(after), "an arrow key does not lessen the load")
    typed = page.set(value=before["load"])
    page.told(
        typed["rows"]["nodes in contact"] == before["rows"]["nodes in contact"],
        "the load that is typed has another contact than before",
    )


def check_probe(page):
    """A map is read under the pointer and by the arrow keys, and zoomed."""
    page.browser.mouse("mouseMoved", page.place("#maps .field", 0.3, 0.6))
    page.told("gap" in page.state()["probe"], "reads nothing under the pointer")
    apart = set()
    for across in [0.1, 0.3, 0.5, 0.7, 0.9]:
        page.browser.mouse("mouseMoved", page.place("#maps .field", across, 0.6))
        apart.update(re.findall(r"pressure .*, apart", page.state()["probe"]))
    page.told(apart == {"pressure 0 Pa, apart"}, f"reads {apart}")
    page.browser.value("document.querySelector('#maps .field').focus()")
    before = page.state()["probe"]
    page.browser.key("ArrowRight")
    page.told(before != page.state()["probe"] != "", "an arrow key does not move what is read")
    bar = "document.querySelector('#maps .scale').textContent"
    whole = page.browser.value(bar)
    page.browser.key("+")
    page.told(page.browser.value(bar) != whole, "a map is not zoomed")
    page.browser.key("0")
    page.told(page.browser.value(bar) == whole, "a map is not shown whole again")


# cancels as soon as progress is told
CANCEL = """new Promise(done => new MutationObserver((_, observer) => {
  if (!/^Solving.* iterations/.test(document.getElementById("status").textContent)) return;
  observer.disconnect();
  document.getElementById("cancel").click();
  done();
}).observe(document.getElementById("status"), { childList: true }))"""


def cancel(page):
    """Begins a solve of adhesion, and cancels it; the state afterwards."""
    given = {"law": "exponential", "work_of_adhesion": "50mJ/m2", "range": "1nm"}
    page.browser.value(f"(() => {{ const cancelled = {CANCEL}; {SET % json.dumps(given)}; return cancelled; }})()")
    return page.idle("a cancel")


def check_cancel(page):
    """A solve that is cancelled ends, and the next one works."""
    before = page.set(size="512", precision="f64")
    state = cancel(page)
    page.told(
        state["status"].startswith("Cancelled") and state["stale"], f"is {state['status']} after it was cancelled"
    )
    page.told(state["rows"] == before["rows"], "shows other figures after it was cancelled")
    state = page.set(size="64", law="none")
    page.told(
        not state["stale"] and state["rows"]["status"] == "converged", f"is {state['status']} after the next solve"
    )


# threads that fail
THREADS = {
    "does not start": 'super("missing.js", { type: "module" })',
    "cannot be made": 'throw new Error("no thread is left")',
    "ends by an error": 'super("data:text/javascript,onmessage = () => { throw new Error() }")',
    "sends what cannot be read": 'super("data:text/javascript,"); setTimeout(() => this.onmessageerror(), 100)',
}


def check_threads(page):
    """A thread that fails is told, and the next one works."""
    page.set(size="512", precision="f64")
    for what, script in THREADS.items():
        cancel(page)
        failing = f"class extends Worker {{ constructor() {{ {script} }} }}"
        page.browser.value(f"globalThis.Whole = Worker; Worker = {failing}; 0")
        state = page.set(size="256", law="none")
        page.told(state["stale"] and "try again" in state["failure"], f"a thread {what}: {state['failure']}")
        page.browser.value("Worker = Whole; 0")
        # what the browser says of it
        page.browser.events.clear()
        page.host.missed.clear()
        state = page.set(size="512")
        page.told(not state["stale"] and not state["failure"], f"{state['failure']} after a thread that {what}")


def check_parts(page):
    """A page of which a part is missing says so."""
    for part in ["page.js", "charts.js", "asperity_web_bg.wasm", "worker.js"]:
        page.host.missing = (part,)
        page.browser.open(page.host.url)
        page.told(page.comes_true("!document.getElementById('failure').hidden"), f"says nothing without {part}")
        page.told("reload" in page.state()["failure"], f"without {part}: {page.state()['failure']}")
    page.browser.events.clear()
    page.host.missed.clear()


def check_wrong(page, folder):
    """Files that are no map, and quantities that are none, are refused in a sentence where they were given."""
    (folder / "words.txt").write_text("heights of\na surface\n")
    (folder / "empty.npy").write_bytes(b"")
    (folder / "nan.txt").write_text("nan nan nan\n" * 3)
    (folder / "cut.npy").write_bytes((folder / "map.npy").read_bytes()[:1000])
    # two gibibytes of heights, of bytes that take no room on the disk
    header = b"{'descr': '|u1', 'fortran_order': False, 'shape': (16384, 16384), }".ljust(117) + b"\n"
    (folder / "large.npy").write_bytes(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
    os.truncate(folder / "large.npy", 10 + len(header) + 16384**2)
    page.set(form="self-affine", size="64")
    for name in ["words.txt", "empty.npy", "nan.txt", "cut.npy", "large.npy"]:
        state = page.drop(folder / name)
        page.told(
            state["stale"] and len(state["errors"]) == 1 and not state["failure"],
            f"{name}: {state['errors']} {state['failure']}",
        )
        page.told(name != "large.npy" or "fewer nodes" in state["errors"][0], f"{name}: {state['errors']}")
        page.quiet()
    state = page.set(form="self-affine")
    page.told(not state["stale"] and not state["errors"], f"does not come back from a wrong file: {state['errors']}")
    for given in [
        {"modulus": "70GPx"},
        {"modulus": "-1GPa"},
        {"hardness": "soft"},
        {"value": "5parsec"},
        {"made_lengths": "0um"},
    ]:
        [(name, wrong)] = given.items()
        right = page.browser.value(f"document.getElementsByName('{name}')[0].value")
        state = page.set(**given)
        page.told(
            state["stale"] and len(state["errors"]) == 1, f"{name} = {wrong}: {state['errors']} {state['failure']}"
        )
        invalid = page.browser.value("[...document.querySelectorAll('[aria-invalid]')].map(input => input.name)")
        page.told(invalid == [name], f"{name} = {wrong}: marks {invalid}")
        if name != "value":
            page.drag(0.4)
            state = page.idle(f"a drag with {given}")
            page.told(state["stale"] and len(state["errors"]) == 1, f"{name} = {wrong} is forgotten under another load")
        state = page.set(**{name: right})
        page.told(not state["stale"] and not state["errors"], f"{name} = {right}: {state['errors']}")


def check_map(page, folder):
    """A map that is dropped is prepared by its steps and solved."""
    state = page.drop(folder / "map.npy")
    page.told(
        len(state["errors"]) == 1 and "side lengths" in state["errors"][0], f"without side lengths: {state['errors']}"
    )
    state = page.set(lengths="500nm")
    steps = [step.split(":")[0] for step in state["steps"]]
    page.told(steps == ["read", "lengths", "detrend", "fill"], f"takes the steps {steps}")
    page.told(
        not state["errors"] and state["rows"]["status"] == "converged", f"map.npy: {state['errors']} {state['failure']}"
    )
    mirrored = page.set(edges="mirror")
    page.told(
        "part of the mirrored map" in mirrored["rows"],
        f"does not mirror: {mirrored['errors']} {list(mirrored['rows'])}",
    )
    sides = page.browser.value("[...document.querySelectorAll('canvas')].map(({ width, height }) => [width, height])")
    page.told(sides == [[96, 96]] * 4, f"shows mirror images: {sides}")
    page.set(edges="")
    return state


def check_cycle(page, folder):
    """A cycle is drawn with its jumps, and what is taken away afterwards is what is shown."""
    page.set(
        form="wave",
        size="64",
        made_lengths="100nm",
        amplitude="1nm",
        periods_x="1",
        periods_y="1",
        modulus="1GPa",
        law="exponential",
        work_of_adhesion="50mJ/m2",
        range="0.5nm",
    )
    page.browser.value("document.getElementById('follow').click()")
    state = page.idle("a cycle")
    page.told(state["charts"]["loop"] == 1, "draws no loop")
    page.told(
        "jump-in" in state["jumps"] and ("jump-out" in state["jumps"] or "pull-off" in state["jumps"]),
        f"tells of the cycle: {state['jumps']}",
    )
    page.save("report.json", folder)
    saved, shown = json.loads((folder / "report.json").read_text())["contact_nodes"], state["rows"]["nodes in contact"]
    page.told(saved == int(shown.split()[0]), f"shows {shown} in contact after the cycle, and saves {saved}")


# the text below a map of the solution: its key, and the load that it does not show
KEYS = """[...document.querySelectorAll("#maps figure")].slice(1).map(map =>
  [...map.querySelectorAll(".key span:not(.ramp, .scaled), .hint")].map(text => text.textContent))"""


def check_colours(page, folder):
    """A spike and a scar leave colours for all else, which say what is beyond, and are held under other loads."""
    page.drop(folder / "scarred.npy")
    state = page.set(lengths="500nm", modulus="1GPa", law="none", control="mean_pressure", value="50MPa")
    pressure, _ = page.browser.value(KEYS)
    page.told("→" in pressure[1] and "% of the load is carried above" in pressure[-1], f"says {pressure} of a scarred map")
    report = float(state["rows"]["greatest pressure"].split()[0])
    page.told(pressure[1].split()[-2] == f"{report:.3g}", f"{pressure[1]} leads to {report}")
    told = page.browser.value("document.getElementById('heights').textContent")
    page.told("above" in told and "up to" in told, "says of no spike in the distribution of the heights")
    page.browser.picture(PICTURES / "scarred.png")
    shades = page.browser.value("""(() => {
      const { width, height } = document.querySelector("#picture canvas");
      const { data } = document.querySelector("#picture canvas").getContext("2d").getImageData(0, 0, width, height);
      const counts = new Map();
      for (const pixel of new Uint32Array(data.buffer)) counts.set(pixel, (counts.get(pixel) ?? 0) + 1);
      return Math.max(...counts.values()) / (width * height);
    })()""")
    page.told(shades < 0.1, f"a scarred map has one colour on {shades:.0%} of its nodes")
    page.set(held=True)
    held = [[text.split(" → ")[0] for text in key[:2]] for key in page.browser.value(KEYS)]
    page.set(value="90MPa")
    kept = [[text.split(" → ")[0] for text in key[:2]] for key in page.browser.value(KEYS)]
    page.told(kept == held, f"colours that are held go from {held} to {kept}")
    page.set(held=False)
    free = [[text.split(" → ")[0] for text in key[:2]] for key in page.browser.value(KEYS)]
    page.told(free[0] != held[0], f"colours that are free stay at {held}")


def check_link(page):
    """The link of a state brings it back, on a page that is opened anew and on one that is open."""
    given = {"form": "wave", "size": "64", "amplitude": "7nm", "law": "exponential", "range": "3nm", "precision": "f32"}
    # from a lighter load, as from the default
    page.set(**PLAIN, value="1MPa")
    page.set(**given)
    state = page.set(value="3MPa", held=True)
    page.told(page.comes_true("document.getElementById('link').textContent.includes('held=')"), "has no link")
    link = page.browser.value("location.hash")

    def compare_with(way):
        is_taken = "document.getElementById('value').value === '3MPa' && " + IDLE
        page.told(page.comes_true(is_taken), f"takes no link {way}")
        found = page.state()
        # without the contact before, where a solve does not start from it
        wanted = state["command"].replace(" --initial-gap start.npz", "").split()
        page.told(found["command"].split() == wanted, f"a link {way} has {found['command']}, not {wanted}")
        page.told(found["rows"]["contact"] == state["rows"]["contact"], f"a link {way} has another contact")
        page.told(page.browser.value("document.getElementsByName('held')[0].checked"), f"holds no colours {way}")

    page.set(**PLAIN, held=False)
    page.set(value="9MPa")
    page.told(page.comes_true("location.hash.includes('value=9MPa')"), "does not keep a state in its address")
    page.browser.value(f"location.hash = {json.dumps(link)}; 0")
    compare_with("on an open page")
    page.host.missing = ()
    page.browser.open("about:blank")
    page.browser.open(page.host.url + link)
    compare_with("on a page that is opened")
    page.host.missing = ALL
    away = "#form=file&map=away.npy"
    page.browser.value(f"location.hash = {json.dumps(away)}; 0")
    asks = "document.getElementById('doubts').textContent.includes('away.npy')"
    page.told(page.comes_true(asks), "does not ask for the map of a link")
    page.idle("a link to a map that is away")


def check_play(page):
    """The loads are played to the heaviest, unless that is stopped."""
    page.set(**{**PLAIN, "size": "64", "k_s": "16"})
    page.drag(0.8)
    before = page.idle("a drag")
    press = "document.getElementById('play').click()"
    is_over = "document.getElementById('play').textContent === 'Play' && " + IDLE
    page.browser.value(press)
    page.told(page.comes_true(is_over), "does not come to the end of the loads")
    after = page.state()
    page.told(share(after) > share(before), f"plays from {share(before)} % to {share(after)} %")
    page.told(page.browser.value("document.getElementById('drag').value") == "1", "does not play to the heaviest load")
    page.told(len(after["solves"]) - len(before["solves"]) >= 8, f"has solved {after['solves']}")
    page.browser.value(f"{press}; {press}; 0")
    page.told(page.comes_true(is_over), "does not stop")
    page.told(share(page.state()) < share(before), "does not begin anew from the lightest load")


def check_area(page):
    """The curve of the area fills in by itself, next to the theory, which is that of the error function."""
    page.set(**{**PLAIN, "size": "64", "k_s": "12"})
    page.browser.value("document.getElementById('forget').click()")
    page.set(value="1MPa")
    dots = "document.querySelector('#area svg path[stroke=\"#214a87\"]').getAttribute('d').split('M').length - 1"
    page.told(page.comes_true(f"{dots} >= 14"), f"fills in {page.browser.value(dots)} loads")
    page.told(page.browser.value("!document.getElementById('persson').hidden"), "has no theory")
    for pressure in [0.01, 0.3, 1.5]:
        found = page.browser.value(
            f"import(new URL('charts.js', location)).then(({{ persson }}) => persson({pressure}))"
        )
        page.told(abs(found - math.erf(2**0.5 * pressure)) < 2e-7, f"has {found} at {pressure}")
    page.set(hardness="80MPa")
    page.told(page.browser.value("document.getElementById('persson').hidden"), "has a theory of what yields")


# counts threads that run from now on
COUNTED = """(() => {
  globalThis.Whole = Worker;
  globalThis.threads = new Set();
  Worker = class extends Whole {
    constructor(...given) { super(...given); threads.add(this); }
    terminate() { threads.delete(this); super.terminate(); }
  };
})()"""


def check_path(page):
    """With adhesion the curve of the area is filled in from the state that is shown, and not after a change."""
    page.set(**{**PLAIN, **SCENES["adhesive"], "size": "64", "k_s": "12"})
    page.browser.value("document.getElementById('forget').click()")
    page.browser.value(COUNTED)
    page.set(value="1MPa")
    # of the loads a ninth of which is above 1 MPa, and that state
    path = "[...document.querySelectorAll('#area svg path[stroke=\"#d6601e\"]')]"
    dots = f"Math.max(0, ...{path}.map(path => path.getAttribute('d').split('M').length - 1))"
    named = "document.getElementById('area').textContent.includes('under more load')"
    page.told(page.comes_true(f"{dots} === 10"), f"fills in {page.browser.value(dots)} loads")
    page.told(page.browser.value(named), "does not name the path of loading")
    page.browser.picture(PICTURES / "path.png")
    page.told(page.comes_true("!threads.size"), "keeps the thread of a path that is complete")
    # a change while the next path is followed
    page.set(value="2MPa")
    page.told(page.comes_true("threads.size"), "follows no path from another state")
    page.drag(0.6)
    page.told(page.browser.value("!threads.size"), "follows a path after a change")
    page.told(not page.browser.value(named) or page.comes_true(f"!{named}"), "shows the path of a state before")
    page.told(page.comes_true(named), "follows no path after a change")
    page.browser.value("Worker = Whole; 0")


def check_words(page):
    """Words tell their lines, and lead to headings that the guide has."""
    words = page.browser.value("""[...document.querySelectorAll("#words dt")].map(word => {
      const line = word.nextElementSibling;
      return [word.textContent, line.textContent, line.querySelector("a").getAttribute("href")];
    })""")
    shown = []
    for given in [{}, {"law": "exponential"}]:
        page.set(**{**PLAIN, **given})
        shown += page.browser.value("[...document.querySelectorAll('.word')].map(word => word.textContent.trim())")
    for word in ["Hurst exponent", "mu_rho", "corrected for its edge", "Persson’s theory"]:
        page.told(word in shown, f"{word} tells no line")
    for word, _, place in words:
        path, _, heading = place.removeprefix("../").partition("#")
        path = path.removesuffix(".html")
        files = [ROOT / "docs" / f"{path}.md", ROOT / "src" / f"{path}.md"]
        text = next((file.read_text() for file in files if file.is_file()), None)
        headings = re.findall(r"^#+ (.*)$", text or "", re.MULTILINE)
        slugs = [re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings]
        page.told(text is not None and (not heading or heading in slugs), f"{word} leads to {place}: {slugs}")
    line = """document.querySelector("#figures .word").click(), document.getElementById("line").textContent"""
    known = next(told for word, told, _ in words if word == "contact")
    page.told(known in page.browser.value(line), "tells no line of a word that is clicked")
    page.browser.value("document.body.click()")
    page.told(page.browser.value("document.getElementById('line').hidden"), "continues to tell a line")


def check_profile(page):
    """A line over the maps has a profile, and another line another one."""
    page.set(**PLAIN)
    charts = "['sides', 'loads'].map(id => document.getElementById(id).innerHTML)"
    press = "document.getElementById('profile').click()"
    middle = page.browser.value(charts)
    page.told(all("<svg" in chart for chart in middle), "draws no profile")
    page.browser.drag(page.place("#maps .field", 0.2, 0.3), (80, 60))
    page.told(page.browser.value(charts) == middle, "takes another line before it is asked to")
    page.browser.value(press)
    page.browser.drag(page.place("#maps .field", 0.2, 0.3), (80, 60))
    drawn = page.browser.value(charts)
    page.told(all(one != other for one, other in zip(middle, drawn, strict=True)), "draws the same profile")
    line = page.browser.value("document.getElementsByName('line')[0].value").split()
    page.told(abs(float(line[0]) - 0.2) < 0.02 and abs(float(line[1]) - 0.7) < 0.02, f"draws a line from {line}")
    page.browser.value(press)
    page.browser.drag(page.place("#maps .field", 0.4, 0.3), (80, 60))
    page.told(page.browser.value(charts) == drawn, "takes another line after it was asked not to")


def check_load(page, folder):
    """A load that the page has chosen is chosen again for each surface, and says so; a load that is typed stays."""
    page.set(**PLAIN)
    chosen = "chosen by the page"
    page.browser.value("history.replaceState(null, '', location.pathname); location.hash = 'size=128'; 0")
    page.told(page.comes_true(f"document.getElementById('status').textContent.includes('{chosen}')"), "chooses no load")
    page.drop(folder / "scarred.npy")
    raw = page.set(lengths="500nm")
    page.told(chosen in raw["status"] and chosen in raw["steps"][-1], f"{raw['status']}: {raw['steps']}")
    clean = page.set(despike=True)
    page.told(chosen in clean["steps"][-1] and clean["load"] != raw["load"], f"keeps {raw['load']} after a step")
    page.set(value="3MPa")
    state = page.set(despike=False)
    page.told(state["load"] == "3MPa" and chosen not in state["status"] + state["steps"][-1], f"{state['status']}")
    state = page.set(form="self-affine", size="64")
    page.told(state["load"] == "3MPa", f"has {state['load']} in the place of the load that was typed")


def check_mask(page, folder):
    """The points under a mask of Gwyddion are missing where that is chosen, and the copied lines say so."""
    (folder / "mask.gwy").write_bytes(masked_gwy())
    label = "document.getElementsByName('masked')[0].parentElement.hidden"
    state = page.drop(folder / "mask.gwy")
    page.told(not page.browser.value(label) and "mask over 2 points" in state["steps"][0], f"{state['steps']}")
    page.told("Masked points are missing" in state["steps"][0], f"{state['steps']}")
    state = page.set(masked=True)
    page.told("2 missing" in state["steps"][0] and "fill" in state["steps"][1], f"{state['steps']} {state['errors']}")
    page.told("--masked" in state["command"] and "masked=True" in state["python"], f"{state['command']}")
    page.drop(folder / "scarred.npy")
    page.told(page.browser.value(label), "offers a mask of a file without one")


def masked_gwy():
    """A file of Gwyddion of 12 by 8 heights with a mask over two of them."""
    item = lambda name, kind, value: name.encode() + b"\0" + kind + value
    made = lambda name, items: name.encode() + b"\0" + struct.pack("<I", len(items)) + items
    heights = [10e-9 * math.sin(0.7 * k) + 3e-9 * math.cos(0.4 * k * k) for k in range(96)]
    mask = [float(k in (17, 50)) for k in range(96)]
    sides = item("xreal", b"d", struct.pack("<d", 3e-6)) + item("yreal", b"d", struct.pack("<d", 2e-6))
    nodes = item("xres", b"i", struct.pack("<i", 12)) + item("yres", b"i", struct.pack("<i", 8))
    unit = item("si_unit_xy", b"o", made("GwySIUnit", item("unitstr", b"s", b"m\0")))
    unit += item("si_unit_z", b"o", made("GwySIUnit", item("unitstr", b"s", b"m\0")))

    def field(values):
        data = item("data", b"D", struct.pack("<I96d", 96, *values))
        return made("GwyDataField", nodes + sides + unit + data)

    channel = item("/0/data", b"o", field(heights)) + item("/0/mask", b"o", field(mask))
    return b"GWYP" + made("GwyContainer", channel)


def check_measured(page):
    """A measured curve lies under the cycle, in the units of its heading."""
    points = "import(new URL('measured.js', location)).then(({ points }) => points(%s))"
    for text, wanted in {
        "gap (nm), pressure (MPa)\n1.5, 2\n\n2 3e1\n": [[1.5e-9, 2e6], [2e-9, 3e7]],
        "Abstand [µm];Kraft [nN]\n1,5;-2\n": [[1.5e-6, -2e-9]],
        "1e-9 5\n": [[1e-9, 5.0]],
    }.items():
        found = page.browser.value(points % json.dumps(text))
        flat = [
            abs(a - b) <= 1e-12 * abs(b)
            for one, other in zip(found, wanted, strict=True)
            for a, b in zip(one, other, strict=True)
        ]
        page.told(all(flat), f"reads {found} of {text!r}")
    type_in = """(text => {
      const input = document.getElementById("measured");
      input.value = text;
      input.dispatchEvent(new Event("change", { bubbles: true }));
      return document.getElementById("loop").textContent + document.querySelector("[data-of=measured]").textContent;
    })(%s)"""
    told = page.browser.value(type_in % json.dumps("1 2\nno number\n"))
    page.told("no number" in told, f"says {told} of a wrong curve")
    told = page.browser.value(type_in % json.dumps("gap (nm), pressure (MPa)\n1 2\n2 3\n"))
    page.told("measured" in told and "mean gap" in told, f"does not draw a measured curve: {told}")
    page.browser.value(type_in % json.dumps(""))


def check_undo(page):
    """What was set before comes back, and the contact with it."""
    before = page.set(**PLAIN, value="2MPa")
    kept = "document.getElementById('link').textContent.includes(%s)"
    page.told(page.comes_true(kept % "'value=2MPa'"), "does not keep a state")
    after = page.set(modulus="2GPa")
    page.told(page.comes_true(kept % "'modulus=2GPa'"), "does not keep a change")
    page.browser.value("document.getElementById('undo').click()")
    state = page.idle("an undo")
    page.told(state["command"] == before["command"], f"undoes to {state['command']}, and not {before['command']}")
    page.told(state["rows"]["contact"] == before["rows"]["contact"], "has another contact after an undo")
    page.browser("Input.dispatchKeyEvent", type="keyDown", key="Z", modifiers=10)
    state = page.idle("a change that is done again")
    page.told(state["command"] == after["command"], f"does again {state['command']}, and not {after['command']}")


def check_large(page):
    """Large type is large, and goes away again."""
    size = "parseFloat(getComputedStyle(document.body).fontSize)"
    press = "document.getElementById('large').click()"
    usual = page.browser.value(size)
    page.browser.value(press)
    page.told(page.browser.value(size) > 1.3 * usual, "has no large type")
    page.browser.picture(PICTURES / "large.png")
    page.browser.value(press)
    page.told(page.browser.value(size) == usual, "keeps the large type")


def check_texts(page, folder):
    """Sentences about a map name the inputs of the page, and no option of the program."""
    for name in ["map.npy", "scarred.npy"]:
        state = page.drop(folder / name)
        state = page.set(lengths="500nm")
        told = [*state["warnings"], *state["errors"], *state["rows"].values(), *state["statistics"].values()]
        page.told(told, "says nothing")
        for text in told:
            page.told(not re.search(r"--[a-z]|\w_\w|=\.\.\.", text), f"{name}: {text}")


# what differs from a self-affine surface of 1 µm under a half-space of 1 GPa without adhesion
SCENES = {
    "plain": {},
    "adhesive": {"law": "exponential", "work_of_adhesion": "20mJ/m2", "range": "2nm"},
    "coated": {
        "body": "coating",
        "coating": "50nm",
        "coating_modulus": "5GPa",
        "coating_poisson": "0.3",
        "poisson": "0.4",
    },
    "yielding": {"hardness": "80MPa"},
    "free": {"form": "sphere", "radius": "0.4um", "boundary": "free"},
    "wave in single precision": {"form": "wave", "amplitude": "10nm", "precision": "f32"},
}
PLAIN = {
    "form": "self-affine",
    "size": "128",
    "k_s": "24",
    "made_lengths": "1um",
    "boundary": "periodic",
    "body": "half-space",
    "hardness": "",
    "law": "none",
    "precision": "f64",
    "modulus": "1GPa",
}


def check_scene(page, name, given, tool, folder):
    """The copied line gives the contact nodes of the page, after a drag."""
    page.browser.where = name
    page.set(**PLAIN)
    page.set(**given)
    page.drag(0.4)
    page.idle("a drag")
    page.drag(0.6)
    state = page.idle("a second drag")
    page.told(not state["errors"] and not state["stale"], f"{state['errors']} {state['failure']}")
    compare(page, state, tool, folder / name)


def compare(page, state, tool, folder):
    """Runs the lines of a state in a shell, and compares the contact."""
    folder.mkdir(exist_ok=True)
    if "start.npz" in state["command"]:
        page.save("start.npz", folder)
    (folder / "asperity").symlink_to(tool)
    ran = subprocess.run(
        ["bash", "-ec", f'PATH="$PWD:$PATH"; {state["command"]}'], cwd=folder, capture_output=True, text=True
    )
    page.told(ran.returncode == 0, f"the copied line fails: {ran.stderr}")
    reports = list(folder.glob("*/report.json"))
    if not reports:
        return page.told(False, f"the copied line writes no report: {state['command']}")
    report, found = json.loads(reports[0].read_text()), state["rows"]["nodes in contact"]
    page.told(
        report["contact_nodes"] == int(found.split()[0]),
        f"{found} in contact, by the copied line {report['contact_nodes']}",
    )
    print(f"{page.browser.where}: {found} nodes in contact, by the program {report['contact_nodes']}")


# the pixels of the smallest text of a chart
TEXT = """Math.min(...[...document.querySelectorAll(".chart text")].map(text => {
  const { a, b } = text.getScreenCTM();
  return text.getAttribute("font-size") * Math.hypot(a, b);
}))"""


# the red of nodes apart and of nodes in contact
GROUND = """(() => {
  const canvas = document.querySelector("#maps canvas"), { width, height } = canvas;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
  const counts = new Map();
  for (let at = 0; at < data.length; at += 4) counts.set(data[at], (counts.get(data[at]) ?? 0) + 1);
  return [...counts].sort(([, a], [, b]) => b - a).map(([red]) => red);
})()"""

# the height of the load, and the places of the contact and of the figures on the page
PLACES = """[document.getElementById("load").offsetHeight,
  ...["#maps canvas", "#figures"].map(at => document.querySelector(at).getBoundingClientRect().top)]"""


def check_pictures(page):
    """The page in all windows, light and dark."""
    for window in WINDOWS:
        for dark in [False, True]:
            page.browser.where = f"{window}, {'dark' if dark else 'light'}"
            page.open(window, dark)
            state = page.state()
            page.told(state["beyond"] <= 0, f"is {state['beyond']} pixels wider than the window")
            small = page.browser.value("""[...document.querySelectorAll("input, select, button, label")]
              .filter(input => input.offsetParent && input.getBoundingClientRect().right > innerWidth + 1).length""")
            page.told(small == 0, f"{small} inputs reach out of the window")
            corner = page.browser.value(GROUND)
            page.told((corner[0] < 64) == dark and (corner[1] < 64) != dark, f"has the colours {corner} of the contact")
            if window == "phone":
                high, contact, figures = page.browser.value(PLACES)
                page.told(high < WINDOWS[window][1] / 5, f"has a load that is {high} pixels high")
                page.told(contact < figures, "has figures above the contact")
            text = page.browser.value(TEXT)
            page.told(text >= 11, f"has text of {text:.1f} pixels in a chart")
            page.browser.picture(PICTURES / f"{window}-{'dark' if dark else 'light'}.png")
            page.quiet()


def measure(page):
    """Prints the times of drags, which are those of this machine."""
    for size, precision in [("256", "f64"), ("256", "f32"), ("512", "f32"), ("512", "f64")]:
        page.set(**{**PLAIN, "size": size, "k_s": "32", "precision": precision})
        seconds = []
        for share in [0.4, 0.45, 0.5, 0.55, 0.6]:
            before = page.browser.value("performance.now()")
            page.drag(share)
            seconds.append((page.idle("a drag")["solves"][-1] - before) / 1000)
        print(f"{size} x {size} in {precision} follows after {', '.join(f'{time:.2f}' for time in seconds)} s")


def make_map(tool, folder):
    """A map as it is measured: tilted, without side lengths, and with missing points."""
    options = "--size 96 --lengths 500nm --rms-slope 0.1 --k-s 16 --tilt 0.02 --quiet --out map.npy"
    subprocess.run([tool, "surface", *options.split()], cwd=folder, check=True)
    raw = bytearray((folder / "map.npy").read_bytes())
    raw[-8 * 500 : -8 * 497] = b"\x00\x00\x00\x00\x00\x00\xf8\x7f" * 3
    (folder / "map.npy").write_bytes(raw)
    # of half the rms slope, with a spike, and with a scar along x, in float64 at the end of the file
    subprocess.run(
        [tool, "surface", *options.replace("0.02", "0").replace("map", "scarred").split()], cwd=folder, check=True
    )
    raw = bytearray((folder / "scarred.npy").read_bytes())
    for node, height in [(40 * 96 + 30, 200e-9), *((node * 96 + 60, 20e-9) for node in range(20, 60))]:
        struct.pack_into("<d", raw, len(raw) - 8 * 96 * 96 + 8 * node, height)
    (folder / "scarred.npy").write_bytes(raw)


def main():
    path, tool, site = sys.argv[1:]
    tool = str(pathlib.Path(tool).resolve())
    PICTURES.mkdir(parents=True, exist_ok=True)
    browser = Browser(path)
    page = Page(browser, Host(site))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_map(tool, folder)
        page.browser.where = "first view"
        page.open("desk")
        first = check_first_view(page)
        print(f"first view after {first / 1000:.2f} s")
        checks = [
            ("drag", check_drag, []),
            ("probe", check_probe, []),
            ("cancel", check_cancel, []),
            ("threads", check_threads, []),
            ("wrong", check_wrong, [folder]),
            ("cycle", check_cycle, [folder]),
            ("colours", check_colours, [folder]),
            ("link", check_link, []),
            ("play", check_play, []),
            ("area", check_area, []),
            ("path", check_path, []),
            ("words", check_words, []),
            ("profile", check_profile, []),
            ("load", check_load, [folder]),
            ("mask", check_mask, [folder]),
            ("measured", check_measured, []),
            ("undo", check_undo, []),
            ("large", check_large, []),
            ("texts", check_texts, [folder]),
        ]
        for page.browser.where, check, more in checks:
            check(page, *more)
            page.quiet()
        page.browser.where = "map"
        (folder / "dropped").mkdir()
        state = check_map(page, folder)
        (folder / "dropped" / "map.npy").write_bytes((folder / "map.npy").read_bytes())
        compare(page, state, tool, folder / "dropped")
        for name, given in SCENES.items():
            check_scene(page, name, given, tool, folder)
            page.quiet()
        measure(page)
    check_pictures(page)
    browser.where = "missing parts"
    check_parts(page)
    browser.close()
    if page.complaints:
        sys.exit(f"{page.complaints} complaints")
    print("the page is as it should be")


main()
