"""The editor checks exercises in a separate process with a time limit."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from http import HTTPStatus
from pathlib import Path

import pytest
from dh_grader.api.http import ProblemError
from dh_grader.catalogue import shipped_folder
from dh_grader.web.tutor_checks import Checking, CheckRequest

SCARA = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
POSE = '\n[[parts]]\nid = "p{}"\nkind = "transform"\ntitle = "Pose"\n'
# Minutes of algebra in 20 kB.
COSTLY = (shipped_folder() / "baxter-left-arm.toml").read_text(encoding="utf-8") + "".join(
    POSE.format(i) for i in range(200)
)
QUICK = CheckRequest(id="scara", text="title = 1")
STARTS_A_CHECK = """
import sys
from dh_grader.web.tutor_checks import Checking
from dh_grader.web.tutor_checks import CheckRequest
checking = Checking(600)
checking.checked(CheckRequest(id="a", text="title = 1"))
print(checking._process.pid, flush=True)
checking.checked(CheckRequest(id="arm", text=sys.stdin.read()))
"""


@pytest.fixture
def checking() -> Iterator[Checking]:
    checking = Checking(600.0)
    yield checking
    checking.close()


def costly() -> CheckRequest:
    return CheckRequest(id="arm", text=COSTLY)


def process_of(checking: Checking) -> "subprocess.Popen[bytes]":
    assert checking._process is not None
    return checking._process


@pytest.mark.long
def test_one_process_checks_one_text_after_the_other(checking: Checking) -> None:
    assert b'"findings":[]' in checking.checked(CheckRequest(id="scara", text=SCARA))
    first = process_of(checking)
    assert b"unusable" in checking.checked(QUICK)
    assert process_of(checking) is first


@pytest.mark.long
def test_checks_that_take_too_long_are_killed(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    checking._seconds = 0.5
    with pytest.raises(ProblemError, match=r"more than 0\.5 seconds") as caught:
        checking.checked(costly())
    assert caught.value.status is HTTPStatus.UNPROCESSABLE_ENTITY
    assert first.poll() == -signal.SIGKILL
    checking._seconds = 600.0
    assert b"unusable" in checking.checked(QUICK)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_a_killed_process_is_restarted(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    assert b"unusable" in checking.checked(QUICK)


def test_a_crashed_check_does_not_affect_the_next_one(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    with pytest.raises(RuntimeError, match="the log"):
        # Too long: the process refuses to read the request.
        checking.checked(CheckRequest.model_construct(id="a", text="x" * 70_000))
    assert b"unusable" in checking.checked(QUICK)
    assert process_of(checking) is first


@pytest.mark.long
def test_the_end_of_the_service_ends_a_check(checking: Checking) -> None:
    told: list[ProblemError] = []
    checking.checked(QUICK)

    def check() -> None:
        with pytest.raises(ProblemError) as caught:
            checking.checked(costly())
        told.append(caught.value)

    thread = threading.Thread(target=check)
    thread.start()
    time.sleep(0.2)
    checking.close()
    thread.join()
    assert [each.status for each in told] == [HTTPStatus.SERVICE_UNAVAILABLE]
    with pytest.raises(ProblemError):
        checking.checked(QUICK)


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc")
def test_the_process_ends_after_the_service_was_killed() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", STARTS_A_CHECK], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as service:
        assert service.stdin is not None
        assert service.stdout is not None
        process = Path(f"/proc/{int(service.stdout.readline())}")
        service.stdin.write(COSTLY.encode())
        service.stdin.close()
        time.sleep(0.5)
        assert process.exists()
        service.kill()
    # An ended process stays as a zombie (Z) until its new parent reads the exit code.
    while process.exists() and ") Z " not in (process / "stat").read_text():
        time.sleep(0.05)
