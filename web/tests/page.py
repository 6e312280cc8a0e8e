"""The page of the browser as a test uses it: its inputs, its state, and the complaints about it."""

import json
import sys

from host import ALL

WINDOWS = {"desk": (1280, 900), "phone": (390, 844)}

# twentieths of a second in which the page has to answer, on a loaded machine
PATIENCE = 1000

IDLE = "!document.body.classList.contains('busy') && document.getElementById('status').textContent !== ''"

# sets inputs of a form, as typing and choosing do
SET = """(given => {
  for (const [name, value] of Object.entries(given)) {
    const input = document.getElementsByName(name)[0];
    if (input.type === "checkbox") input.checked = value; else input.value = value;
    for (const kind of ["input", "change"]) input.dispatchEvent(new Event(kind, { bubbles: true }));
  }
})(%s)"""

STATE = """(() => {
  const text = id => document.getElementById(id).textContent;
  const cells = row => [...row.cells].map(cell => cell.textContent);
  const rows = id => Object.fromEntries([...document.querySelectorAll(`#${id} tr`)].map(cells));
  const charts = ["area", "pressures", "gaps", "heights", "spectrum", "loop"];
  const shown = selector => [...document.querySelectorAll(selector)].filter(node => node.offsetParent !== null);
  return {
    status: text("status"), failure: document.getElementById("failure").hidden ? "" : text("failure"),
    errors: shown("output.error").map(error => error.textContent).filter(Boolean),
    warnings: shown(".warnings li").map(item => item.textContent),
    stale: document.getElementById("stage").classList.contains("stale"),
    rows: rows("rows"), statistics: rows("statistics"), steps: shown("#steps li").map(item => item.textContent),
    load: document.getElementById("value").value, probe: text("probe"), jumps: text("jumps"),
    command: text("command"), python: text("python"),
    charts: Object.fromEntries(charts.map(id => [id, document.querySelectorAll(`#${id} svg`).length])),
    solves: performance.getEntriesByName("contact").map(mark => mark.startTime),
    beyond: document.documentElement.scrollWidth - innerWidth,
  };
})()"""


class Page:
    """The page in a browser, and the complaints about it."""

    def __init__(self, browser, host):
        self.browser, self.host, self.complaints = browser, host, 0
        browser.online(True)

    def told(self, holds, what):
        if not holds:
            print(f"{self.browser.where}: {what}", file=sys.stderr)
            self.complaints += 1

    def open(self, window, dark=False):
        """Opens the page, and takes its host away."""
        width, height = WINDOWS[window]
        self.browser(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False
        )
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.browser("Emulation.setEmulatedMedia", features=[scheme])
        self.host.missing = ()
        self.browser.open(self.host.url)
        self.idle("it is opened")
        self.host.missing = ALL

    def state(self):
        return self.browser.value(STATE)

    def comes_true(self, condition):
        return self.browser.comes_true(condition, PATIENCE)

    def idle(self, step):
        """The state of the page once it has done what was asked for."""
        if not self.comes_true(IDLE):
            self.browser.fail(f"does not come to rest after {step}: {self.state()}")
        return self.state()

    def set(self, **given):
        self.browser.value(SET % json.dumps(given))
        return self.idle(f"{given}")

    def drag(self, share):
        """Puts the slider of the load to a share of its way."""
        self.browser.value(f"""(() => {{
          const slider = document.getElementById("drag");
          slider.value = {share};
          slider.dispatchEvent(new Event("input", {{ bubbles: true }}));
        }})()""")

    def place(self, selector, across=0.5, down=0.5):
        """A point on an element, on the screen."""
        return self.browser.value(f"""(() => {{
          const element = document.querySelector({json.dumps(selector)});
          element.scrollIntoView({{ block: "center" }});
          const {{ x, y, width, height }} = element.getBoundingClientRect();
          return [x + {across} * width, y + {down} * height];
        }})()""")

    def drop(self, path):
        """Drops a file on the page."""
        data = {"items": [], "files": [str(path)], "dragOperationsMask": 1}
        for kind in ["dragEnter", "dragOver", "drop"]:
            self.browser("Input.dispatchDragEvent", type=kind, x=200, y=300, data=data)
        opened = "document.getElementById('opened').textContent.startsWith(" + json.dumps(path.name) + ")"
        self.told(self.comes_true(opened), f"does not open {path.name}")
        return self.idle(f"the drop of {path.name}")

    def save(self, name, folder):
        """Saves a file by its button."""
        self.browser("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder), eventsEnabled=True)
        self.browser.events.clear()
        self.browser.value(f"document.querySelector('[data-file=\"{name}\"]').click()")
        self.browser.wait(f"file {name}", lambda event: event["params"].get("state") == "completed")

    def quiet(self):
        """Complains about what the browser has complained of, and about what was asked of hosts that are away."""
        self.told(not self.host.missed, f"asks for {self.host.missed}")
        self.host.missed.clear()
        for event in self.browser.events:
            params = event["params"]
            match event["method"]:
                case "Runtime.exceptionThrown" | "Log.entryAdded" | "Runtime.consoleAPICalled":
                    self.told(False, f"{params}")
                case "Network.requestWillBeSent":
                    asked = params["request"]["url"]
                    self.told(asked.startswith((self.host.url, "data:", "blob:")), f"asks for {asked:.100}")
        self.browser.events.clear()
