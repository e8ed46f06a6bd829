"""Headless Chromium by the pipe of its DevTools protocol: a page is looked at once it has drawn itself."""

import contextlib
import itertools
import json
import os
import select
import shutil
import subprocess
import time

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
LIMIT = 120.0  # s, for one answer, on a machine under load
# the browser reads commands from descriptor 3 and writes answers to 4
START = 'exec "$0" "$@" 3<&0 4>&1 </dev/null >/dev/null 2>&1'
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
    "--host-resolver-rules=MAP * ~NOTFOUND", "--remote-debugging-pipe",
)  # fmt: skip


class Page:
    """A page of the browser: commands and events of the DevTools protocol, messages that end in a zero byte."""

    def __init__(self, process):
        self._process, self._numbers, self._pending, self._session = process, itertools.count(1), b"", None
        self.events = []  # of the page, in the order in which they came
        target = self.command("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.command("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def command(self, method, **params):
        """Result of one command."""
        number = next(self._numbers)
        session = {"sessionId": self._session} if self._session else {}
        message = {"id": number, "method": method, "params": params, **session}
        os.write(self._process.stdin.fileno(), json.dumps(message).encode() + b"\0")
        answer = self._next(lambda one: one.get("id") == number)
        assert "error" not in answer, answer["error"]
        return answer["result"]

    def open(self, address):
        """Load a page."""
        for domain in ("Page", "Runtime", "Log"):
            self.command(f"{domain}.enable")
        self.command("Page.navigate", url=address)
        self._next(lambda one: one.get("method") == "Page.loadEventFired")

    def evaluate(self, expression):
        """Value of an expression in the page; a promise is waited for."""
        found = self.command("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def _next(self, wanted):
        """The next message that is wanted; the events before it are kept."""
        while not wanted(message := self._message()):
            self.events.append(message)
        return message

    def _message(self):
        end, answers = time.monotonic() + LIMIT, self._process.stdout.fileno()
        while b"\0" not in self._pending:
            ready, _, _ = select.select([answers], [], [], max(end - time.monotonic(), 0.0))
            assert ready, f"the browser gave no answer in {LIMIT:g} s"
            part = os.read(answers, 1 << 16)
            assert part, "the browser ended"
            self._pending += part
        first, self._pending = self._pending.split(b"\0", 1)
        return json.loads(first)


@contextlib.contextmanager
def page_of_browser(profile):
    """An empty `Page` of a browser of its own, whose profile lies in a folder; it ends with the context."""
    command = ["sh", "-c", START, CHROMIUM, *FLAGS, f"--user-data-dir={profile}"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        try:
            yield Page(process)
        finally:
            process.terminate()
