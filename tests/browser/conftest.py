"""Fixtures: a real service, and web servers on two origins that are not the service's."""

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from tests.api.serving import served
from tests.browser.hostile import HOSTILE_EXERCISE


@dataclass
class Origin:
    """A web server on an origin that is not the service's; ``pages`` has its pages by path."""

    address: str
    pages: dict[str, str] = field(default_factory=dict)


@pytest.fixture(scope="session")
def other_origin() -> Iterator[Origin]:
    """Return the server of a course site that the service allows."""
    with origin() as made:
        yield made


@pytest.fixture(scope="session")
def stranger() -> Iterator[Origin]:
    """Return the server of a site that the service does not allow."""
    with origin() as made:
        yield made


@contextmanager
def origin() -> Iterator[Origin]:
    """Start a web server on a free port."""
    # Browsers ask each site for its icon, sooner or later.
    pages: dict[str, str] = {"/favicon.ico": ""}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            text = pages.get(self.path)
            self.send_response(200 if text is not None else 404)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write((text or "").encode())

        def log_message(self, *arguments: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield Origin(f"http://127.0.0.1:{server.server_port}", pages)
        server.shutdown()
        thread.join()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory, other_origin: Origin) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("exercises")
    (folder / "hostile.toml").write_text(HOSTILE_EXERCISE, encoding="utf-8")
    variables = {
        "DH_GRADER_CORS_ORIGINS": other_origin.address,
        "DH_GRADER_EXERCISES_DIR": f"shipped{os.pathsep}{folder}",
    }
    with served(tmp_path_factory.mktemp("service"), **variables) as server:
        yield server.address


@pytest.fixture(scope="session")
def axe() -> str:
    """Return the script of axe-core, which checks accessibility."""
    return next((Path(__file__).parent / "axe-core").glob("axe-*.min.js")).read_text("utf-8")
