"""A browser without a window, led by its DevTools protocol over a pipe."""

import base64
import itertools
import json
import os
import select
import subprocess
import sys
import tempfile

# what a browser does by itself on the network
SILENT = "disable-quic disable-background-networking disable-component-update disable-sync".split()

# the numbers of keys with a name
KEYS = {"Escape": 27, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}

# seconds until a browser that is silent has failed
PATIENCE = 60


class Browser:
    """A browser with one tab."""

    def __init__(self, path):
        (commands, self.commands), (self.answers, answers) = os.pipe(), os.pipe()
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        flags = ["headless", "no-sandbox", "disable-gpu", "no-first-run", "remote-debugging-pipe", *SILENT]
        start = f'LD_LIBRARY_PATH=$BROWSER_LIBRARIES exec "$0" "$@" 3<&{commands} 4>&{answers}'
        self.process = subprocess.Popen(
            ["bash", "-c", start, path, *(f"--{flag}" for flag in flags), f"--user-data-dir={self.profile.name}"],
            pass_fds=(commands, answers),
            stdin=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(commands)
        os.close(answers)
        self.numbers, self.rest, self.events, self.session = itertools.count(1), b"", [], None
        # what it is led through, for messages
        self.where = path
        target = self("Target.createTarget", url="about:blank")["targetId"]
        self.session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self(f"{domain}.enable")
        self.online(False)

    def online(self, is_on):
        """Switches the network on or off, which is off at first."""
        speed = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
        self("Network.emulateNetworkConditions", offline=not is_on, **speed)

    def fail(self, what):
        sys.exit(f"{self.where}: {what}")

    def message(self, wanted):
        """The next message of the browser, of which something is wanted."""
        while b"\0" not in self.rest:
            if not select.select([self.answers], [], [], PATIENCE)[0]:
                self.fail(f"the browser has said nothing for {PATIENCE} seconds: no {wanted}")
            read = os.read(self.answers, 1 << 16)
            if not read:
                self.fail(f"the browser has ended by {self.process.wait()}: no {wanted}")
            self.rest += read
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def __call__(self, method, **params):
        """The answer to a command; events until then are kept."""
        number = next(self.numbers)
        command = {"id": number, "method": method, "params": params}
        if self.session:
            command["sessionId"] = self.session
        os.write(self.commands, json.dumps(command).encode() + b"\0")
        wanted = f"answer to {method} {params.get('expression', ''):.200}"
        while (message := self.message(wanted)).get("id") != number:
            self.events.append(message)
        if "error" in message:
            self.fail(f"{method}: {message['error']}")
        return message["result"]

    def wait(self, wanted, holds):
        """Waits for an event of which something holds."""
        while not any(map(holds, self.events)):
            self.events.append(self.message(wanted))

    def open(self, url):
        """Opens a page, and returns when it has loaded."""
        self.events.clear()
        self("Page.navigate", url=url)
        self.wait(f"load of {url}", lambda event: event["method"] == "Page.loadEventFired")

    def close(self):
        self("Browser.close")
        self.process.wait()
        self.profile.cleanup()

    def value(self, script):
        """The value of a script, or of what it promises."""
        answer = self("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            self.fail(f"{answer['exceptionDetails']}")
        return answer["result"].get("value")

    def mouse(self, kind, at, **params):
        self("Input.dispatchMouseEvent", type=kind, x=at[0], y=at[1], **params)

    def click(self, at, count=1):
        for times in range(1, count + 1):
            for kind in ["mousePressed", "mouseReleased"]:
                self.mouse(kind, at, button="left", clickCount=times)

    def wheel(self, at, turn):
        self.mouse("mouseWheel", at, deltaX=0, deltaY=turn)

    def comes_true(self, condition, times=100):
        """Whether a condition comes true within so many twentieths of a second: scrolling takes a while."""
        return self.value(f"""new Promise(done => {{
          const look = times => ({condition}) || !times ? done(times > 0) : setTimeout(look, 50, times - 1);
          look({times});
        }})""")

    def drag(self, at, by):
        """Moves the mouse with its button pressed."""
        to = [at[0] + by[0], at[1] + by[1]]
        self.mouse("mousePressed", at, button="left", clickCount=1)
        self.mouse("mouseMoved", to, button="left", buttons=1)
        self.mouse("mouseReleased", to, button="left", clickCount=1)

    def key(self, key):
        """Presses a key: a character, or one of those with a name."""
        more = {"windowsVirtualKeyCode": KEYS[key], "code": key} if key in KEYS else {"text": key}
        self("Input.dispatchKeyEvent", type="keyDown", key=key, **more)
        self("Input.dispatchKeyEvent", type="keyUp", key=key)

    def picture(self, path):
        """The whole page as a picture."""
        size = self("Page.getLayoutMetrics")["cssContentSize"]
        answer = self("Page.captureScreenshot", clip={**size, "scale": 1}, captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(answer["data"]))
