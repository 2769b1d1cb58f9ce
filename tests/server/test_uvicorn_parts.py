"""Check the undocumented parts of uvicorn that the server uses."""

# If a new version of uvicorn changes one of these parts, the tests name the part.

import ast
import asyncio
import inspect
import textwrap
from collections.abc import Iterator
from functools import cache
from typing import Any

import uvicorn
from dh_grader.server import Server
from dh_grader.server.connections import GuardedProtocol, GuardedState, Valve
from uvicorn.protocols.http.flow_control import FlowControl
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle
from uvicorn.server import ServerState

from tests.together import together

# For each class of uvicorn: its methods with their parameters, and its instances' attributes.
METHODS: dict[type, dict[str, list[str]]] = {
    HttpToolsProtocol: {
        "__init__": ["self", "config", "server_state", "app_state", "_loop"],
        "connection_made": ["self", "transport"],
        "connection_lost": ["self", "exc"],
        "on_headers_complete": ["self"],
        "on_message_complete": ["self"],
        "on_response_complete": ["self"],
        "pause_writing": ["self"],
        "resume_writing": ["self"],
        "shutdown": ["self"],
    },
    FlowControl: {
        "__init__": ["self", "transport"],
        "pause_reading": ["self"],
        "resume_reading": ["self"],
    },
    uvicorn.Server: {
        "__init__": ["self", "config"],
        "capture_signals": ["self"],
        "handle_exit": ["self", "sig", "frame"],
        "on_tick": ["self", "counter"],
        "startup": ["self", "sockets"],
        "shutdown": ["self", "sockets"],
    },
}
ATTRIBUTES: dict[type, set[str]] = {
    HttpToolsProtocol: {
        "access_log", "access_logger", "app", "client", "config", "cycle", "flow", "headers",
        "loop", "parser", "scope", "server_state", "transport", "url",
    },
    FlowControl: {"write_paused"},
    uvicorn.Server: {"config", "lifespan", "servers", "server_state", "should_exit"},
    ServerState: {"connections", "tasks", "total_requests"},
    RequestResponseCycle: {
        "disconnected", "keep_alive", "message_event", "response_complete", "response_started",
    },
}  # fmt: skip


def tree_of(of: type) -> ast.AST:
    """Return the syntax tree of a class."""
    return ast.parse(textwrap.dedent(inspect.getsource(of)))


def set_on_self(of: type) -> set[str]:
    found = set()
    for node in ast.walk(tree_of(of)):
        match node:
            case ast.AnnAssign(target=ast.Name(id=name)):
                found.add(name)
            case ast.Attribute(value=ast.Name(id="self"), attr=name, ctx=ast.Store()):
                found.add(name)
            case _:
                pass
    return found


def read_from(of: type, *owners: str) -> Iterator[str]:
    for node in ast.walk(tree_of(of)):
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) in owners:
            yield node.attr


@cache
def own_names(of: type) -> set[str]:
    return set(vars(of)) | (set_on_self(of) - ATTRIBUTES[of.__mro__[1]])


@together("of", METHODS)
def test_uvicorn_has_the_methods_with_their_parameters(of: type) -> None:
    for name, parameters in METHODS[of].items():
        assert list(inspect.signature(getattr(of, name)).parameters) == parameters, name


@together("of", ATTRIBUTES)
def test_uvicorn_has_the_attributes(of: type) -> None:
    assert ATTRIBUTES[of] - set_on_self(of) == set()


@together("of", [GuardedProtocol, Valve, Server])
def test_no_other_part_of_uvicorn_is_used(of: type) -> None:
    base = of.__mro__[1]
    named = METHODS[base].keys() | ATTRIBUTES[base] | own_names(of)
    assert set(read_from(of, "self", "super()")) - named == set()


def test_no_other_attribute_of_a_cycle_or_of_the_state_is_used() -> None:
    used = set(read_from(GuardedProtocol, "self.cycle", "cycle"))
    assert used == ATTRIBUTES[RequestResponseCycle]
    for of in (GuardedProtocol, Server):
        used = set(read_from(of, "self.server_state"))
        assert used <= ATTRIBUTES[ServerState] | set(vars(GuardedState)) | set_on_self(GuardedState)


def test_the_event_of_a_cycle_is_an_asyncio_event() -> None:
    annotation: Any = inspect.signature(RequestResponseCycle.__init__).parameters["message_event"]
    assert annotation.annotation in (asyncio.Event, "asyncio.Event")
