"""Run nginx as a proxy of services on this machine, with the configuration of compose.yaml."""

import re
import socket
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from tests.guards import ANSWER

CONFIGURATION: Final = Path(__file__).parents[2] / "deploy" / "nginx.conf"


def free_port() -> int:
    """Return a port that is not in use."""
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
        return port


@contextmanager
def nginx(program: str, folder: Path, ports: Sequence[int]) -> Iterator[int]:
    """Run a proxy of the services at ``ports``; yield its port."""
    port = free_port()
    text = CONFIGURATION.read_text(encoding="utf-8")
    for number, replica in enumerate(ports, 1):
        text = text.replace(f"grader-{number}:8000", f"127.0.0.1:{replica}")
    assert "grader-" not in re.sub(r"#.*", "", text)
    text = text.replace("listen 8080", f"listen 127.0.0.1:{port}").replace("/tmp/", f"{folder}/")
    (file := folder / "nginx.conf").write_text(text, encoding="utf-8")
    command = [program, "-c", str(file), "-e", "stderr", "-g", "daemon off;"]
    with (folder / "nginx.log").open("wb") as log:
        process = subprocess.Popen(command, stdout=log, stderr=log)
        try:
            while process.poll() is None:
                with suppress(OSError):
                    socket.create_connection(("127.0.0.1", port), ANSWER).close()
                    break
            assert process.poll() is None, (folder / "nginx.log").read_text(encoding="utf-8")
            yield port
        finally:
            process.terminate()
            process.wait(ANSWER)
