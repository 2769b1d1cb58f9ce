"""Unread responses count towards the byte limit of their connection."""

import asyncio
import contextlib
import socket
from typing import Any

import uvicorn
from dh_grader.server.connections import (
    ConnectionLimits,
    GuardedProtocol,
    GuardedState,
    OpenConnections,
)

from tests.server.raw import HEALTH

MB = 1024 * 1024
ANSWER = 8 * MB
LIMIT = 24 * MB


async def large(_scope: Any, _receive: Any, send: Any) -> None:
    """Send a large response in one piece."""
    length = (b"content-length", str(ANSWER).encode())
    await send({"type": "http.response.start", "status": 200, "headers": [length]})
    await send({"type": "http.response.body", "body": bytes(ANSWER)})


async def unsent_to(clients: int, *, reading: bool) -> tuple[int, int]:
    loop = asyncio.get_running_loop()
    config = uvicorn.Config(large, http=GuardedProtocol, ws="none", log_level="critical")
    config.load()
    state = GuardedState()
    state.open_connections = OpenConnections(ConnectionLimits(unfinished=LIMIT))
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
        unsent = sum(each._raw.get_write_buffer_size() for each in connections)
        return unsent, len(connections)
    finally:
        server.close()
        for line in lines:
            line.close()
        for each in list(state.connections):
            with contextlib.suppress(AttributeError):
                each.reset()  # type: ignore[union-attr]
        await asyncio.sleep(0)


def test_the_bytes_of_unread_answers_are_bounded() -> None:
    unsent, _ = asyncio.run(unsent_to(12, reading=False))
    # The last answer may exceed the limit until other connections have been closed.
    assert ANSWER // 4 < unsent <= LIMIT + ANSWER


def test_clients_that_read_their_answers_stay_connected() -> None:
    assert asyncio.run(unsent_to(12, reading=True)) == (0, 12)
