"""Answer requests and commands by the program of the working folder: ``answering.py IN OUT``.

This file runs in a process of its own with the program of another checkout, so it imports nothing
of the project by itself, and asks the program only by what users have: its application, its
command and ``dh_grader.grade``. A line of IN is a request or a command; the same line of OUT is
what came back.
"""

import asyncio
import gc
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from http import HTTPStatus
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

# Where the program was, oldest last.
_PACKAGES = ("dh_grader", "service")
# What differs between two runs of the same program.
_CHANGING = (
    (re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d+)?(?:Z|[+-]\d\d:\d\d)?"), b"TIME"),
    (re.compile(rb'(nonce[-=]"?)[\w+/=-]{16,}'), rb"\1NONCE"),
    (re.compile(rb"[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}"), b"UUID"),
    (re.compile(rb'"request_id": ?"[0-9a-f]+"'), b'"request_id": "ID"'),
    (re.compile(rb'"seconds": ?[\d.e-]+'), b'"seconds":SECONDS'),
    (re.compile(rb'time="[\d.e-]+"'), b'time="SECONDS"'),
)
_HEADERS = ("content-type", "content-language", "vary", "cache-control", "allow", "location")


class Program:
    """The program of a checkout."""

    def __init__(self, checkout: Path) -> None:
        sys.path.insert(0, str(checkout))
        folders = [checkout / "service", checkout]
        self._package, self._root = next(
            (name, folder)
            for name in _PACKAGES
            for folder in folders
            if (folder / name / "app.py").is_file()
        )
        sys.path.insert(0, str(self._root))
        self._app = import_module(f"{self._package}.app").app
        self._face = import_module(self._package)
        self._loop = asyncio.new_event_loop()
        self._budgets: list[object] = []
        self._watch_budgets()
        gc.collect()
        gc.freeze()

    def _watch_budgets(self) -> None:
        # The work of a submission is no part of its answer, but changes costly ones.
        names = ("WorkBudget",)
        found = {
            getattr(module, name)
            for module in list(sys.modules.values())
            for name in names
            if getattr(module, "__name__", "").startswith(self._package) and hasattr(module, name)
        }
        for kind in found:
            self._watch(kind)

    def _watch(self, kind: type) -> None:
        begin: Callable[..., None] = vars(kind)["__init__"]

        def watched(budget: object, *args: object, **named: object) -> None:
            begin(budget, *args, **named)
            self._budgets.append(budget)

        setattr(kind, "__init__", watched)  # noqa: B010 - no type has such an attribute to set

    def _spent(self) -> list[list[object]]:
        names = ("symbols", "repairs", "pasted", "pasted_signs", "explanations", "searches")
        spent = [[getattr(each, name, None) for name in names] for each in self._budgets]
        self._budgets.clear()
        return spent

    def answered(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Return what the program answers."""
        if asked["words"]:
            return self._ran(asked)
        return self._reported(asked) if asked["by_face"] else self._requested(asked)

    def _reported(self, asked: dict[str, Any]) -> dict[str, Any]:
        # The report as JSON, from the face of the package if there is one.
        if not hasattr(self._face, "grade"):
            answer = self._requested(asked)
            body = answer["body"] if answer["status"] == HTTPStatus.OK else None
            return {"body": body, "spent": answer["spent"]}
        exercise = asked["path"].removeprefix("/v1/exercises/").partition("/")[0]
        given = asked["body"]
        try:
            # The service limits the level to that of the exercise, as the default of the face does.
            report = self._face.grade(
                exercise, given["answers"], angle_unit=given["angle_unit"], feedback=None
            )
        except (LookupError, ValueError):
            return {"body": None, "spent": self._spent()}
        return {"body": self._lasting(report.to_json().encode()), "spent": self._spent()}

    def _requested(self, asked: dict[str, Any]) -> dict[str, Any]:
        status, headers, pieces = 0, dict[str, str](), list[bytes]()
        content = b"" if asked["body"] is None else json.dumps(asked["body"]).encode()

        async def receive() -> dict[str, Any]:
            return {"type": "http.request", "body": content, "more_body": False}

        async def send(message: dict[str, Any]) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                headers.update((k.decode(), v.decode()) for k, v in message["headers"])
            else:
                pieces.append(message.get("body", b""))

        url = urlsplit(str(asked["path"]))
        scope = {
            "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "scheme": "http",
            "method": asked["method"], "path": url.path, "raw_path": url.path.encode(),
            "query_string": url.query.encode(), "root_path": "", "client": ("127.0.0.1", 1),
            "server": ("127.0.0.1", 80), "headers": [
                (b"host", b"127.0.0.1"), (b"content-type", b"application/json"),
                (b"accept", b"text/html,application/json;q=0.9,*/*;q=0.5"),
                (b"content-length", str(len(content)).encode()),
            ],
        }  # fmt: skip
        try:
            self._loop.run_until_complete(self._app(scope, receive, send))
        except Exception as error:  # noqa: BLE001 - the other checkout may answer
            pieces.append(f"{type(error).__name__}: {error}".encode())
        return {
            "status": status,
            "headers": {name: headers.get(name) for name in _HEADERS},
            "body": self._lasting(b"".join(pieces)),
            "spent": self._spent(),
        }

    def _ran(self, asked: dict[str, Any]) -> dict[str, Any]:
        words = list(asked["words"])
        environment = {**os.environ, "PYTHONPATH": str(self._root), "COLUMNS": "100"}
        if words[:1] == ["--lang"]:
            environment["DH_GRADER_LANGUAGE"] = words[1]
            words = words[2:]
        folder = Path(tempfile.mkdtemp())
        try:
            for name, text in asked["files"].items():
                (folder / name).write_text(text, encoding="utf-8")
            done = subprocess.run(
                [sys.executable, "-m", self._package, *words],
                cwd=folder,
                env=environment,
                capture_output=True,
            )
            written = {
                file.name: self._lasting(file.read_bytes())
                for file in sorted(folder.iterdir())
                if file.name not in asked["files"]
            }
        finally:
            shutil.rmtree(folder)
        return {
            "status": done.returncode,
            "body": self._lasting(done.stdout),
            "errors": self._lasting(done.stderr),
            "written": written,
        }

    def _lasting(self, content: bytes) -> str:
        for pattern, word in _CHANGING:
            content = pattern.sub(word, content)
        return content.decode("utf-8", "backslashreplace")


def main() -> None:
    """Answer each line of a file into another one."""
    asked, answers = map(Path, sys.argv[1:])
    program = Program(Path.cwd())
    with asked.open(encoding="utf-8") as lines, answers.open("w", encoding="utf-8") as out:
        for line in lines:
            out.write(json.dumps(program.answered(json.loads(line)), ensure_ascii=True) + "\n")


if __name__ == "__main__":
    main()
