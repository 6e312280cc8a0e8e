#!/usr/bin/env python3
"""Opens the page of the browser in Chromium, uses it as people do, and compares its answers with those of the program.

    web/tests/use.py BROWSER TOOL SITE

The page is served from the folder SITE by a host that is away once the page has loaded. Exits with 1 and the complaints
if something is not as it should be. Pictures are in target/web-pictures.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from browser import Browser
from host import Host
from page import SET, WINDOWS, Page

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
            state = page.idle(f"a drag beside {given}")
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
