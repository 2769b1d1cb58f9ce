"""Floods of requests, as an attacker sends them. Each flood runs until its time is over."""

import itertools
import json
import socket
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from functools import cache
from itertools import islice
from typing import Any, Final

from tests.attack.honest import EXERCISE, GRADE
from tests.benchmarks.server import request
from tests.load.wrong_answers import tables
from tests.server.raw import Service
from tests.worst.bodies import KNOWN
from tests.worst.entry_points import Attack
from tests.worst.seeds import links_of

HEAD = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\n"
CHUNKED = HEAD + b"Transfer-Encoding: chunked\r\n\r\n"
SOURCE = "127.0.0.3"
# The number of the costliest submissions that fit into a body of 256 KiB.
MANY = 16

Flood = Callable[[Service, ExitStack, float], str]
# Takes the number of a connection, and returns the address of its client.
Source = Callable[[int], str]


def half_open(heads: int) -> Flood:
    """Return a flood of connections that send incomplete headers."""

    def flood(running: Service, opened: ExitStack, until: float) -> str:
        lines = [opened.enter_context(running.connect(HEAD, SOURCE)) for _ in range(heads)]
        while time.monotonic() < until:
            time.sleep(0.05)
        return f"{len(lines)} connections opened"

    return flood


def half_bodies(bodies: int) -> Flood:
    """Return a flood of connections that never finish their large body."""

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
    """Return a flood of connections that send ``begin``, then ``piece`` again and again."""

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
    """Return a flood of connections that send one byte of a body each second."""

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
    """Return the costliest answers that a submission may have."""
    # Each number gives other texts.
    return {"answers": {"links": links_of("c12 " * 33, number)}}


def _written(body: dict[str, Any]) -> bytes:
    return json.dumps(body, ensure_ascii=False).encode()


def one_costly(number: int) -> bytes:
    """Return the bytes of a request with one costly submission."""
    return request(GRADE, _written(costly_answers(number)))


def many_costly(number: int) -> bytes:
    """Return the bytes of a request with as many costly submissions as allowed."""
    numbers = range(MANY * number, MANY * (number + 1))
    submissions = [{"exercise": EXERCISE, **costly_answers(i)} for i in numbers]
    return request("/v1/grade", _written({"submissions": submissions}))


# The fields whose texts are names; all other texts are what students write.
_NAMES: Final = ("exercise", "part", "angle_unit", "quantity", "structure", "figure")


def _spelled(value: Any, number: int) -> Any:
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


# Brackets that a pasted table may not have; as many as a pasted text may have characters.
_BRACKETS: Final = "[" + "(" * 12_900 + ")" * 12_900 + "]"

# The costliest bodies, one for each kind of work.
KINDS: Final = {
    "sines in degrees": (GRADE, KNOWN["links of sines in degrees"]),
    "roots": (GRADE, KNOWN["links of roots"]),
    "unread cells": (GRADE, KNOWN["unread cells in another unit"]),
    "many previews": ("/v1/previews", KNOWN["many previews of halves"]),
    "frames": ("/v1/frames", KNOWN["a free table of long cells"]),
    "brackets": (
        GRADE,
        Attack(
            "grade", EXERCISE, {"answers": dict.fromkeys(("table", "links", "pose"), _BRACKETS)}
        ),
    ),
}


def of_kind(kind: str) -> Callable[[int], bytes]:
    path, known = KINDS[kind]

    def numbered(number: int) -> bytes:
        return request(path, _written(_spelled({**known.body}, number)))

    return numbered


@cache
def _honest_bodies() -> list[bytes]:
    several = islice(tables(seed=2, wrong=0.5), 500)
    return [request(f"/v1/exercises/{each.exercise}/grade", each.content) for each in several]


def one_honest(number: int) -> bytes:
    """Return the bytes of a request with an ordinary submission."""
    return _honest_bodies()[number % len(_honest_bodies())]


def from_one_address(_: int) -> str:
    return SOURCE


def from_addresses(number: int) -> str:
    return f"127.0.3.{number + 1}"


def costly(
    body: Callable[[int], bytes] = one_costly,
    source: Source = from_one_address,
    *,
    again: bool = True,
) -> Flood:
    """Return a flood of requests on 16 connections, by default of costly ones."""

    # If `again` is false, each request opens a new connection.
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
        return f"{next(answered)} requests answered"

    return flood


def _answer(line: socket.socket, until: float) -> bool:
    received = b""
    while time.monotonic() < until:
        with suppress(TimeoutError):
            part = line.recv(10**6)
            if not part:
                return False
            received += part
            head, _, body = received.partition(b"\r\n\r\n")
            if len(body) >= int(head.lower().partition(b"content-length: ")[2].split()[0]):
                return True
    return False
