"""Check exercise files for the editor, in a process that is killed if it takes too long."""

import os
import subprocess
import sys
import threading
import weakref
from http import HTTPStatus
from typing import IO, Final

from service.api.http.problems import ProblemError
from service.translations import ENGLISH, Language, say
from service.web.tutor.exercise_check import CheckRequest

# Ten times what `exercises check` takes for the largest exercise of the catalogue.
SECONDS: Final = 20.0
# An idle process ends, because it holds about 120 MB.
IDLE_SECONDS: Final = 300.0
# Seconds until a new process is ready, even on a very busy machine.
_START: Final = 60.0
# The first byte of a message.
READY: Final = b"r"
DONE: Final = b"d"
_MODULE: Final = "service.web.tutor.check_process"


class Checking:
    """Checks exercise files one by one in a process of its own."""

    # The process starts with the first check.

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds = seconds
        self._process: subprocess.Popen[bytes] | None = None
        self._is_ready = False
        self._closed = False

    def checked(self, body: CheckRequest, language: Language = ENGLISH) -> bytes:
        """Return the findings on an exercise file as JSON. Raises ProblemError.

        Only one thread may call this method at a time.
        """
        # ProblemError if the checks take too long, or if the service ends.
        if self._process is None or self._process.poll() is not None:
            self._start()
        process = self._process
        assert process is not None
        try:
            content = self._asked(process, f"{language.code}\n{body.model_dump_json()}".encode())
        except BaseException as error:
            _end(process)
            if self._closed:
                raise _ending() from error
            if isinstance(error, _TooLongError):
                raise _too_long(self._seconds) from error
            if isinstance(error, OSError) and process.returncode == 0:
                # The idle process has ended just now.
                return self.checked(body, language)
            raise
        if not content:
            raise RuntimeError("the checks failed; the log has their traceback")
        return content

    def close(self) -> None:
        """Kill the process, even during a check."""
        self._closed = True
        if self._process is not None:
            # The thread that waits for its answer finds the pipe closed.
            self._process.kill()

    def _start(self) -> None:
        if self._closed:
            raise _ending()
        # In a new session, Ctrl+C in the terminal reaches only the service, which kills this one.
        self._process = subprocess.Popen(
            [sys.executable, "-m", _MODULE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=os.name == "posix",
        )
        self._is_ready = False
        weakref.finalize(self, _end, self._process)

    def _asked(self, process: "subprocess.Popen[bytes]", body: bytes) -> bytes:
        # The service may have ended just before this process was started.
        if self._closed:
            raise ConnectionResetError
        if not self._is_ready:
            _answer(process, READY, _START)
            self._is_ready = True
        assert process.stdin is not None
        send(process.stdin, DONE, body)
        return _answer(process, DONE, self._seconds)


class _TooLongError(Exception):
    """The process has not replied in time."""


def _answer(process: "subprocess.Popen[bytes]", expected: bytes, seconds: float) -> bytes:
    late = threading.Event()

    def give_up() -> None:
        late.set()
        process.kill()

    timer = threading.Timer(seconds, give_up)
    timer.daemon = True
    timer.start()
    try:
        assert process.stdout is not None
        kind, content = received(process.stdout)
    except EOFError as error:
        if late.is_set():
            raise _TooLongError from error
        raise ConnectionResetError("the process of the checks has ended") from error
    finally:
        timer.cancel()
    return content if kind == expected else b""


def send(pipe: IO[bytes], kind: bytes, content: bytes = b"") -> None:
    """Write a message: a byte for its kind, its length, its content."""
    pipe.write(kind + len(content).to_bytes(4) + content)
    pipe.flush()


def received(pipe: IO[bytes]) -> tuple[bytes, bytes]:
    """Return the kind and the content of the next message. Raises EOFError."""
    head = pipe.read(5)
    content = pipe.read(int.from_bytes(head[1:])) if len(head) == 5 else b""
    if len(head) < 5 or len(content) < int.from_bytes(head[1:]):
        raise EOFError
    return head[:1], content


def _end(process: "subprocess.Popen[bytes]") -> None:
    process.kill()
    process.wait()
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            try:
                pipe.close()
            except OSError:
                # A part of the last message was not written.
                continue


def _too_long(seconds: float) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        say(
            "The checks of this exercise take more than {seconds} seconds, so they were stopped. "
            "Check fewer parts at once, or use dh-grader exercises check FILE, which has no limit.",
            seconds=f"{seconds:g}",
        ),
        "checks-too-long",
        say("The checks take too long"),
    )


def _ending() -> ProblemError:
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        say("The service is shutting down. Send this request again in a minute."),
        headers={"Retry-After": "60"},
    )
