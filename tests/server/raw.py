"""Start real processes of the service, and send raw bytes to them."""

import contextlib
import json
import os
import re
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from tests.guards import ANSWER

ROOT = Path(__file__).parents[2]
TEXT = b'{"text": "l1c1", "exercise": "planar-rrr"}'
HOST = b"Host: x\r\n"
HEALTH = b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n"


def until(holds: Callable[[], bool]) -> None:
    """Wait until a condition holds."""
    while not holds():
        time.sleep(0.02)


def preview(body: bytes = TEXT, *headers: bytes) -> bytes:
    lines = [b"POST /v1/preview HTTP/1.1", b"Host: x", b"Content-Length: %d" % len(body), *headers]
    return b"\r\n".join(lines) + b"\r\n\r\n" + body


class Service:
    """A running process of the service, with its log."""

    def __init__(self, process: "subprocess.Popen[bytes]", log: Path) -> None:
        self.process = process
        self._log = log
        self.port = self._wait_for_port()

    @property
    def log(self) -> str:
        return self._log.read_text(encoding="utf-8")

    def _wait_for_port(self) -> int:
        while True:
            if found := re.search(r"running on http://\S+:(\d+)", self.log):
                return int(found[1])
            if self.process.poll() is not None:
                raise AssertionError(f"the server has ended:\n{self.log}")
            time.sleep(0.02)

    def connect(self, sent: bytes = b"", source: str = "127.0.0.1") -> socket.socket:
        end = time.monotonic() + ANSWER
        while True:
            try:
                connection = socket.create_connection(
                    ("127.0.0.1", self.port), ANSWER, source_address=(source, 0)
                )
            except ConnectionRefusedError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.02)
            else:
                connection.sendall(sent)
                return connection

    def ask(self, sent: bytes, source: str = "127.0.0.1") -> list["Answer"]:
        """Send bytes and return all responses."""
        with self.connect(sent, source) as connection:
            connection.shutdown(socket.SHUT_WR)
            return answers(connection)

    def end(self) -> int:
        """Terminate the process; return its exit code."""
        self.process.terminate()
        return self.process.wait(timeout=ANSWER)

    def memory(self) -> float:
        """Return the resident memory of the process in MB."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        found = re.search(r"VmRSS:\s+(\d+)", status)
        return int(found[1]) / 1024 if found else float("nan")


class Answer:
    """The status, headers and body of one response."""

    def __init__(self, head: bytes, body: bytes) -> None:
        line, *fields = head.decode("ascii").split("\r\n")
        self.status = int(line.split()[1])
        self.headers = {
            name.lower(): value for name, value in (field.split(": ", 1) for field in fields)
        }
        self.body = body

    def json(self) -> Any:
        return json.loads(self.body)


def received(connection: socket.socket) -> bytes:
    """Return all bytes that come until the server closes the connection."""
    parts = []
    with contextlib.suppress(ConnectionResetError):
        while part := connection.recv(65536):
            parts.append(part)
    return b"".join(parts)


def answers(connection: socket.socket) -> list[Answer]:
    """Return all responses until the server closes the connection."""
    # Fail if one is incomplete.
    stream, found = received(connection), []
    while stream:
        head, end, rest = stream.partition(b"\r\n\r\n")
        assert end, f"a head is cut off: {head!r}"
        size = int(re.search(rb"content-length: (\d+)", head)[1])  # type: ignore[index]
        assert len(rest) >= size, f"an answer is cut off: {stream!r}"
        found.append(Answer(head, rest[:size]))
        stream = rest[size:]
    return found


def workers(running: Service) -> set[int]:
    """Return the worker processes of the service."""
    found = set()
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            if parent == running.process.pid and b"resource_tracker" not in (
                (folder / "cmdline").read_bytes()
            ):
                found.add(int(folder.name))
    return found


@contextlib.contextmanager
def service(
    folder: Path, *options: str, module: str = "dh_grader", **settings: str
) -> Iterator[Service]:
    """Run the service on a free port, with its log in ``folder``."""
    log = folder / "log"
    command = [sys.executable, "-m", module, "serve", "--port", "0", *options]
    environment = os.environ | {"NO_COLOR": "1"} | settings
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output, env=environment
        ) as process,
    ):
        try:
            yield Service(process, log)
        finally:
            process.kill()
    assert "Traceback" not in log.read_text(encoding="utf-8"), log.read_text(encoding="utf-8")
