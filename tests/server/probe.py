"""Compare how servers treat slow clients: `python -m tests.server.probe`."""

# Print the seconds after which each server closes the connection of each client, as a table in
# Markdown. granian and hypercorn are installed into a temporary folder; a server that cannot be
# installed has no column.

import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path

from tests.server.raw import HEALTH, ROOT

SECONDS = 60.0
APP = "dh_grader.app:app"
HALF_A_HEAD = b"GET /healthz HTTP/1.1\r\nHost: x\r\n"
HALF_A_BODY = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\n{"
LARGE = b"GET /openapi.json HTTP/1.1\r\nHost: x\r\n\r\n"
# For each client: what it sends first, and what it then sends each second.
CLIENTS: dict[str, tuple[bytes, bytes]] = {
    "sends nothing": (b"", b""),
    "sends half a head": (HALF_A_HEAD, b""),
    "sends a head byte by byte": (HALF_A_HEAD + b"X-Slow: ", b"x"),
    "sends half a body": (HALF_A_BODY, b""),
    "sends a body byte by byte": (HALF_A_BODY, b" "),
    "sends nothing more after an answer": (HEALTH, b""),
    "does not read its answers": (LARGE * 500, b""),
}
# For each server: the packages to install, and its command.
SERVERS: dict[str, tuple[list[str], list[str]]] = {
    "dh-grader": ([], ["dh_grader", "serve", "--port"]),
    "uvicorn, httptools": ([], ["uvicorn", APP, "--http", "httptools", "--port"]),
    "uvicorn, h11": (["h11"], ["uvicorn", APP, "--http", "h11", "--port"]),
    "granian": (["granian"], ["granian", "--interface", "asgi", APP, "--port"]),
    "hypercorn": (["hypercorn"], ["hypercorn", APP, "--bind"]),
}


def seconds_until_closed(port: int, client: str) -> float | None:
    """Return the seconds until the server closes the connection, or None if it never does."""
    first, each_second = CLIENTS[client]
    reads = client != "does not read its answers"
    with socket.create_connection(("127.0.0.1", port)) as connection:
        began = time.monotonic()
        connection.setblocking(False)
        watched = select.poll()
        watched.register(connection, select.POLLRDHUP)
        left = first
        while (passed := time.monotonic() - began) < SECONDS:
            if watched.poll(0):
                return passed
            with suppress(OSError):
                left = left[connection.send(left) :] if left else left
            with suppress(OSError):
                if reads:
                    connection.recv(65536)
            time.sleep(1.0)
            left = left or each_second
    return None


def listens(port: int) -> bool:
    """True if a server listens on the port."""
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
        return True
    return False


def free_port() -> int:
    """Return a port that is not in use."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def probed(packages: list[str], command: list[str]) -> Mapping[str, float | None] | None:
    with tempfile.TemporaryDirectory() as folder, (Path(folder) / "log").open("wb") as log:
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--target", folder]
        if packages and subprocess.run([*pip, *packages], stderr=log, check=False).returncode:
            return None
        port = free_port()
        address = f"127.0.0.1:{port}" if command[-1] == "--bind" else str(port)
        server = subprocess.Popen(
            [sys.executable, "-m", *command, address],
            cwd=ROOT,
            stdout=log,
            stderr=log,
            start_new_session=True,
            env=os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"},
        )
        try:
            end = time.monotonic() + SECONDS
            while not listens(port):
                if server.poll() is not None or time.monotonic() > end:
                    return None
                time.sleep(0.1)
            with ThreadPoolExecutor(len(CLIENTS)) as threads:
                seconds = threads.map(partial(seconds_until_closed, port), CLIENTS)
                return dict(zip(CLIENTS, seconds, strict=True))
        finally:
            # Some servers leave workers behind.
            os.killpg(server.pid, signal.SIGKILL)
            server.wait()


def main() -> None:
    columns = {name: found for name, how in SERVERS.items() if (found := probed(*how)) is not None}
    lines = [["a client that …", *columns], ["---"] * (1 + len(columns))]
    for client in CLIENTS:
        seconds = (column[client] for column in columns.values())
        lines.append([client, *("never" if s is None else f"{s:.0f} s" for s in seconds)])
    for line in lines:
        sys.stdout.write(f"| {' | '.join(line)} |\n")


if __name__ == "__main__":
    main()
