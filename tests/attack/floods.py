"""What an attacker sends. Each goes on until its time is over, and keeps what it has opened."""

import itertools
import json
import socket
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from typing import Any, Final

from tests.attack.honest import EXERCISE, GRADE
from tests.benchmarks.server import request
from tests.server.raw import Service
from tests.worst.bodies import KNOWN
from tests.worst.seeds import links_of

HEAD = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\n"
CHUNKED = HEAD + b"Transfer-Encoding: chunked\r\n\r\n"
SOURCE = "127.0.0.3"
# As many of the costliest submissions as a body of 256 KiB holds.
MANY = 16

Flood = Callable[[Service, ExitStack, float], str]


def half_open(heads: int) -> Flood:
    """So many connections with half a head, each opened again as soon as it is closed."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        lines = [opened.enter_context(running.connect(HEAD, SOURCE)) for _ in range(heads)]
        while time.monotonic() < until:
            time.sleep(0.05)
        return f"{len(lines)} connections opened"

    return flood


def half_bodies(bodies: int) -> Flood:
    """So many connections with all of a large body but its end."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = HEAD + b"Content-Length: 260000\r\n\r\n" + b" " * 250_000
        whole = 0
        while whole < bodies and time.monotonic() < until:
            with suppress(OSError):
                opened.enter_context(running.connect(sent, SOURCE))
                whole += 1
        while time.monotonic() < until:
            time.sleep(0.05)
        return f"{whole * 0.25:.0f} MB sent"

    return flood


def endless(begin: bytes, piece: bytes) -> Flood:
    """The same piece again and again behind a beginning, as fast as it is taken."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = tries = 0
        while time.monotonic() < until:
            tries += 1
            with running.connect(begin, SOURCE) as line, suppress(OSError):
                line.settimeout(1.0)
                while time.monotonic() < until:
                    sent += line.send(piece)
        return f"{sent / 1e6:.0f} MB taken on {tries} connections"

    return flood


def dripping(lines: int) -> Flood:
    """So many bodies of which a byte comes each second."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        sent = HEAD + b"Content-Length: 1000\r\n\r\n"
        dripping = [opened.enter_context(running.connect(sent, SOURCE)) for _ in range(lines)]
        closed: set[socket.socket] = set()
        while time.monotonic() < until:
            for line in dripping:
                try:
                    line.send(b" ")
                except OSError:
                    closed.add(line)
            time.sleep(1.0)
        return f"{len(closed)} of {lines} closed"

    return flood


def costly_answers(number: int) -> dict[str, Any]:
    """Answers that take as much work as a submission may; no two are alike."""
    return {"answers": {"links": links_of("c12 " * 33, number)}}


def _written(body: dict[str, Any]) -> bytes:
    return json.dumps(body, ensure_ascii=False).encode()


def one_costly(number: int) -> bytes:
    """One costly submission as it goes over the wire."""
    return request(GRADE, _written(costly_answers(number)))


def many_costly(number: int) -> bytes:
    """As many costly submissions as one request may hold."""
    numbers = range(MANY * number, MANY * (number + 1))
    submissions = [{"exercise": EXERCISE, **costly_answers(i)} for i in numbers]
    return request("/v1/grade", _written({"submissions": submissions}))


# The fields of which the texts are no texts of students.
_NAMES: Final = ("exercise", "part", "angle_unit", "quantity", "structure", "figure")


def _spelled(value: Any, number: int) -> Any:
    """The body with other spaces behind each text, so that none was read before."""
    match value:
        case dict():
            return {
                key: each if key in _NAMES else _spelled(each, number)
                for key, each in value.items()
            }
        case list():
            return [_spelled(each, number) for each in value]
        case str() if len(value) > 1 and "\n" not in value:
            return value + "".join(" \t"[number >> i & 1] for i in range(12))
    return value


# The kinds of bodies that cost most, one of each sort of work.
KINDS: Final = {
    "sines in degrees": (GRADE, KNOWN["links of sines in degrees"]),
    "roots": (GRADE, KNOWN["links of roots"]),
    "unread cells": (GRADE, KNOWN["unread cells in another unit"]),
    "many previews": ("/v1/previews", KNOWN["many previews of halves"]),
    "frames": ("/v1/frames", KNOWN["a free table of long cells"]),
}


def of_kind(kind: str) -> Callable[[int], bytes]:
    """The bodies of one of the kinds; no two are alike."""
    path, known = KINDS[kind]

    def numbered(number: int) -> bytes:
        return request(path, _written(_spelled({**known.body}, number)))

    return numbered


def from_one_address(_: int) -> str:
    """The address of each attacking connection: the same for all."""
    return SOURCE


def from_addresses(number: int) -> str:
    """The address of each attacking connection: one of its own."""
    return f"127.0.3.{number + 1}"


def costly(
    body: Callable[[int], bytes] = one_costly,
    source: Callable[[int], str] = from_one_address,
    *,
    again: bool = True,
) -> Flood:
    """Costly requests on 16 connections, each sent as soon as the last is answered.

    Not ``again`` over the same connection, each has one of its own.
    """

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        numbers, lock, answered = itertools.count(), threading.Lock(), itertools.count()

        def attack(place: int) -> None:
            while time.monotonic() < until:
                with suppress(OSError), running.connect(b"", source(place)) as line:
                    line.settimeout(1.0)
                    while time.monotonic() < until:
                        with lock:
                            number = next(numbers)
                        line.sendall(body(number))
                        if not _answer(line, until):
                            break
                        next(answered)
                        if not again:
                            break

        threads = [threading.Thread(target=attack, args=(place,)) for place in range(16)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return f"{next(answered)} costly requests answered"

    return flood


def _answer(line: socket.socket, until: float) -> bool:
    """Read one answer; false where the connection ends, or the time."""
    came = b""
    while time.monotonic() < until:
        with suppress(TimeoutError):
            part = line.recv(10**6)
            if not part:
                return False
            came += part
            head, _, body = came.partition(b"\r\n\r\n")
            if len(body) >= int(head.lower().partition(b"content-length: ")[2].split()[0]):
                return True
    return False
