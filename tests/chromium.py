"""Drives a headless Chromium that can reach this machine alone, over its debugging pipe."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.browser.chromium import find_chromium

Message = dict[str, Any]

FOUND = find_chromium()
# The browser reads file 3 and writes file 4.
_ON_THE_PIPES = """
import os, sys
os.dup2(int(sys.argv[1]), 3)
os.dup2(int(sys.argv[2]), 4)
os.execv(sys.argv[3], sys.argv[3:])
"""
_OPTIONS = [
    "--headless", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--remote-debugging-pipe",
    # Every name and address but this machine's leads nowhere.
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]  # fmt: skip


class Page:
    """One page of a browser; ``requests`` are the addresses that it asked for, ``complaints`` what
    the browser refused or threw."""

    def __init__(self, commands: int, answers: int) -> None:
        self._commands = commands
        self._answers = answers
        self._buffer = b""
        self._count = 0
        self._session: Message = {}
        self.requests: list[str] = []
        self.complaints: list[str] = []
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        attached = self._call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for domain in ("Network", "Log", "Runtime", "Page"):
            self._call(f"{domain}.enable")

    def open(self, url: str) -> None:
        """Go to an address."""
        self._call("Page.navigate", url=url)

    def show_as(self, media: str, scheme: str = "light") -> None:
        """Show pages as on this medium, "screen" or "print", in this colour scheme."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self._call("Emulation.setEmulatedMedia", media=media, features=features)

    def resize(self, width: int, height: int = 800) -> None:
        """Show pages in a window of this size, in CSS pixels."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self._call("Emulation.setDeviceMetricsOverride", **size)

    def wait_for(self, expression: str) -> Any:
        """The value of an expression of JavaScript as soon as it is true; the test's own timeout
        is the guard."""
        while not (value := self._evaluate(expression)):
            pass
        return value

    def _evaluate(self, expression: str) -> Any:
        # A breath for the page between two looks.
        waiting = f"new Promise(done => setTimeout(() => done({expression}), 20))"
        answer = self._call(
            "Runtime.evaluate", expression=waiting, awaitPromise=True, returnByValue=True
        )
        return answer["result"].get("value")

    def _call(self, method: str, **parameters: Any) -> Message:
        self._count += 1
        command = {"id": self._count, "method": method, "params": parameters, **self._session}
        os.write(self._commands, json.dumps(command).encode() + b"\0")
        while True:
            message = self._received()
            if message.get("id") == self._count:
                assert "error" not in message, message
                result: Message = message["result"]
                return result
            self._note(message)

    def _received(self) -> Message:
        while b"\0" not in self._buffer:
            piece = os.read(self._answers, 65536)
            assert piece, "the browser has ended"
            self._buffer += piece
        text, _, self._buffer = self._buffer.partition(b"\0")
        message: Message = json.loads(text)
        return message

    def _note(self, event: Message) -> None:
        match event.get("method"), event.get("params"):
            case "Network.requestWillBeSent", {"request": {"url": str(url)}}:
                self.requests.append(url)
            case "Log.entryAdded", {"entry": {"level": "error", "text": str(text)}}:
                self.complaints.append(text)
            case "Runtime.exceptionThrown", {"exceptionDetails": {"text": str(text)}}:
                self.complaints.append(text)


@contextmanager
def blank_page() -> Iterator[Page]:
    """A page of a fresh browser, which ends with it."""
    assert FOUND is not None
    to_browser, commands = os.pipe()
    answers, from_browser = os.pipe()
    rights = ["--no-sandbox"] if os.geteuid() == 0 else []
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder,
        subprocess.Popen(
            [
                *(sys.executable, "-c", _ON_THE_PIPES, str(to_browser), str(from_browser)),
                *(FOUND.program, *_OPTIONS, *rights, f"--user-data-dir={folder}"),
            ],
            pass_fds=(to_browser, from_browser),
            env={**os.environ, **FOUND.environment},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as process,
    ):
        os.close(to_browser)
        os.close(from_browser)
        try:
            yield Page(commands, answers)
        finally:
            process.terminate()
            os.close(commands)
            os.close(answers)
