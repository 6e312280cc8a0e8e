"""The host of the page: a server that lets nothing be kept in a cache, and that can go away."""

import functools
import http.server
import threading

# the end of every path
ALL = ("",)


class Host(http.server.ThreadingHTTPServer):
    """Serves a folder, but for the paths that end in `missing`, and keeps in `missed` which of these were asked for."""

    def __init__(self, folder):
        super().__init__(("127.0.0.1", 0), functools.partial(Answer, directory=folder))
        self.url = f"http://127.0.0.1:{self.server_port}/"
        self.missing, self.missed = (), []
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Answer(http.server.SimpleHTTPRequestHandler):
    def do_GET(self):
        if not self.path.endswith(self.server.missing):
            return super().do_GET()
        # the connection ends without an answer
        self.server.missed.append(self.path)

    def end_headers(self):
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *_):
        pass
