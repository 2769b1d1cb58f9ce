"""Answers that nobody reads: what is kept of them counts as held by the client."""

import asyncio
import contextlib
import socket
from typing import Any

import uvicorn

from service.server.connections.guarded_state import GuardedState
from service.server.connections.open_connections import Crowd, Room
from service.server.connections.protocol import GuardedProtocol
from tests.server.raw import HEALTH

MB = 1024 * 1024
ANSWER = 8 * MB
ROOM = 24 * MB


async def large(_scope: Any, _receive: Any, send: Any) -> None:
    """Give a large answer in one piece."""
    length = (b"content-length", str(ANSWER).encode())
    await send({"type": "http.response.start", "status": 200, "headers": [length]})
    await send({"type": "http.response.body", "body": bytes(ANSWER)})


async def kept_of(clients: int, *, reading: bool) -> tuple[int, int]:
    """The bytes that a process keeps of the answers to so many clients; how many stay connected."""
    loop = asyncio.get_running_loop()
    config = uvicorn.Config(large, http=GuardedProtocol, ws="none", log_level="critical")
    config.load()
    state = GuardedState()
    state.crowd = Crowd(Room(unfinished=ROOM))
    server = await loop.create_server(lambda: GuardedProtocol(config, state, {}), "127.0.0.1", 0)
    address = server.sockets[0].getsockname()
    lines = [socket.socket() for _ in range(clients)]
    try:
        for line in lines:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096 if not reading else MB)
            line.setblocking(False)
            await loop.sock_connect(line, address)
            await loop.sock_sendall(line, HEALTH)
            got = 0
            while reading and got < ANSWER:
                got += len(await loop.sock_recv(line, MB))
            await asyncio.sleep(0.02)
        connections: Any = list(state.connections)
        kept = sum(each._raw.get_write_buffer_size() for each in connections)
        return kept, len(connections)
    finally:
        server.close()
        for line in lines:
            line.close()
        for each in list(state.connections):
            with contextlib.suppress(AttributeError):
                each.reset()  # type: ignore[union-attr]
        await asyncio.sleep(0)


def test_answers_that_nobody_reads_have_their_bound() -> None:
    kept, _ = asyncio.run(kept_of(12, reading=False))
    # Of the last answer, as much as there is, before others make room for it.
    assert ANSWER // 4 < kept <= ROOM + ANSWER


def test_answers_that_are_read_are_held_against_nobody() -> None:
    assert asyncio.run(kept_of(12, reading=True)) == (0, 12)
