"""Test how a process shuts down and replaces killed workers."""

import json
import os
import signal
import socket
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from dh_grader.catalogue import shipped_folder
from dh_grader.server.connections import MAX_CONNECTIONS

from tests.attack.floods import many_costly
from tests.guards import ANSWER
from tests.server.raw import HEALTH, Service, answers, preview, received, service, until, workers
from tests.web.test_tutor_checks import COSTLY

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")

IMPATIENT = "tests.server.impatient"
HALF = len(preview()) - 20


def refuses(running: Service) -> bool:
    try:
        socket.create_connection(("127.0.0.1", running.port), ANSWER).close()
    except OSError:
        return True
    return False


def runs(process: int) -> bool:
    """True if a process runs; False for a zombie."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def check_end(running: Service) -> None:
    with (
        running.connect(preview()[:HALF]) as half,
        running.connect(b"GET /healthz HTT") as head,
        running.connect() as idle,
    ):
        # Answers on other connections show that these have been accepted.
        for _ in range(5):
            running.ask(HEALTH)
        running.process.terminate()
        until(lambda: refuses(running))
        assert received(idle) == b""
        assert received(head) == b""
        half.sendall(preview()[HALF:])
        (answer,) = answers(half)
        assert answer.status == 200
        assert answer.headers["connection"] == "close"
    assert running.process.wait(ANSWER) == 0


@pytest.mark.long
def test_a_begun_request_is_answered_and_idle_connections_are_closed(
    tmp_path: Path,
) -> None:
    with service(tmp_path) as running:
        check_end(running)


@pytest.mark.long
def test_an_incomplete_body_does_not_delay_the_shutdown_and_is_reset(tmp_path: Path) -> None:
    # On a busy machine, its usual timeout may be over before it is asked to end.
    with (
        service(tmp_path, module=IMPATIENT, TIMEOUT="600") as running,
        running.connect(preview()[:HALF]) as half,
    ):
        running.ask(HEALTH)
        assert running.end() == 0
        with pytest.raises(ConnectionResetError):
            half.recv(100)


@pytest.mark.long
@pytest.mark.parametrize("options", [(), ("--workers", "2")], ids=["alone", "workers"])
def test_a_second_signal_ends_it_at_once(tmp_path: Path, options: tuple[str, ...]) -> None:
    with service(tmp_path, *options) as running, running.connect(preview()[:HALF]):
        running.ask(HEALTH)
        running.ask(HEALTH)
        staff = workers(running)
        running.process.send_signal(signal.SIGINT)
        until(lambda: refuses(running))
        assert running.process.poll() is None
        began = time.monotonic()
        running.process.terminate()
        assert running.process.wait(ANSWER) == -signal.SIGTERM
        # Without the second signal, the incomplete body would keep it running for eight seconds.
        assert time.monotonic() - began < 5
        until(lambda: not any(map(runs, staff)))


@pytest.mark.long
def test_answers_are_complete_if_the_service_ends_while_sending_them(tmp_path: Path) -> None:
    pipelined = 200
    with service(tmp_path, module=IMPATIENT) as running:
        with ExitStack() as stack:
            lines = [stack.enter_context(running.connect(preview() * pipelined)) for _ in range(20)]
            for line in lines:
                line.recv(1, socket.MSG_PEEK)
            assert running.end() == 0
            # `answers` fails if one is incomplete.
            found = [answer.status for line in lines for answer in answers(line)]
        assert set(found) == {200}
        assert len(found) < 20 * pipelined


@pytest.mark.long
def test_answers_that_the_shutdown_interrupts_log_no_error(tmp_path: Path) -> None:
    hanging = b"GET /hanging HTTP/1.1\r\nHost: x\r\n\r\n"
    with service(tmp_path, module=IMPATIENT) as running:
        with ExitStack() as stack:
            sent = [hanging, *(many_costly(i) for i in range(4))]
            lines = [stack.enter_context(running.connect(each)) for each in sent]
            until(lambda: not running.ask(HEALTH)[0].status - 200)
            assert running.end() == 0
            assert [received(line) for line in lines].count(b"")
        # `service` checks that the log has no traceback.
        assert "Exception" not in running.log


@pytest.mark.long
def test_a_running_thread_does_not_delay_the_shutdown(tmp_path: Path) -> None:
    working = b"GET /working HTTP/1.1\r\nHost: x\r\n\r\n"
    with service(tmp_path, module=IMPATIENT) as running, running.connect(working) as line:
        running.ask(HEALTH)
        assert running.end() == 0
        assert received(line) == b""
        assert "Something does not react" in running.log


# The shutdown comes while the process of the check starts, and while it works.
@pytest.mark.long
@pytest.mark.parametrize("seconds", [0.0, 4.0])
def test_a_check_of_the_editor_does_not_delay_the_shutdown(tmp_path: Path, seconds: float) -> None:
    body = json.dumps({"id": "arm", "text": COSTLY}).encode()
    head = b"POST /tutor/check HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: %d\r\n\r\n"
    head %= len(body)
    with service(tmp_path, module=IMPATIENT) as running, running.connect(head + body) as line:
        until(lambda: len(workers(running)) == 1)
        [check] = workers(running)
        time.sleep(seconds)
        assert running.end() == 0
        assert received(line) == b""
        until(lambda: not runs(check))


def connections(process: int) -> set[str]:
    """Return the names of a process's open sockets."""
    files = Path(f"/proc/{process}/fd").iterdir()
    return {name for file in files if (name := str(file.readlink())).startswith("socket:")}


def check_shares(running: Service, staff: set[int]) -> None:
    before = {worker: connections(worker) for worker in staff}
    with ExitStack() as lines:
        for _ in range(40):
            lines.enter_context(running.connect(HEALTH)).recv(1)
        # The server may still be closing an earlier connection.
        more = [len(connections(worker) - had) for worker, had in before.items()]
    assert sum(more) == 40
    assert min(more) >= 10


def request(method: str, path: str, body: object = None) -> bytes:
    content = b"" if body is None else json.dumps(body).encode()
    head = f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {len(content)}\r\n"
    return head.encode() + b"Connection: close\r\n\r\n" + content


def written_draft(running: Service) -> str:
    text = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")
    draft = ""
    for title in ("Planar", "Flat"):
        changed = {"id": "arm", "text": text.replace("Planar", title), "draft": draft}
        [answer] = running.ask(request("POST", "/tutor/drafts", changed))
        assert draft in ("", answer.json()["draft"])
        draft = answer.json()["draft"]
    return draft


def check_draft(running: Service, draft: str) -> None:
    with ExitStack() as lines:
        opened = [lines.enter_context(running.connect()) for _ in range(6)]
        for line in opened:
            line.sendall(request("GET", f"/v1/exercises/{draft}"))
        found = [answer for line in opened for answer in answers(line)]
    assert [(answer.status, answer.json().get("title")) for answer in found] == [
        (200, "Flat RR arm")
    ] * 6


@pytest.mark.long
def test_workers_share_connections_and_drafts_and_a_killed_one_is_replaced(
    tmp_path: Path,
) -> None:
    with service(tmp_path, "--workers", "2") as running:
        # It has logged that it is running: it accepts connections.
        assert not refuses(running)
        until(lambda: running.log.count("startup complete") == 2)
        assert running.log.count("running on") == 1
        before = workers(running)
        assert len(before) == 2
        check_shares(running, before)
        draft = written_draft(running)
        check_draft(running, draft)
        os.kill(min(before), signal.SIGKILL)
        until(lambda: running.log.count("startup complete") == 3)
        after = workers(running)
        assert len(after) == 2
        assert len(after & before) == 1
        check_draft(running, draft)
        check_end(running)


@pytest.mark.long
def test_workers_end_when_their_supervisor_is_killed(tmp_path: Path) -> None:
    with service(tmp_path, "--workers", "2") as running:
        until(lambda: running.log.count("startup complete") == 2)
        staff = workers(running)
        running.process.kill()
        running.process.wait(ANSWER)
        until(lambda: not any(map(runs, staff)))


@pytest.fixture(scope="session")
def lasting(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    # A process that several tests share; it writes no address into its log.
    folder = tmp_path_factory.mktemp("lasting")
    with service(folder, DH_GRADER_LOG_ADDRESSES="false") as running:
        yield running
        assert running.end() == 0


@pytest.mark.long
def test_many_open_connections_do_not_prevent_answers_and_take_little_memory(
    lasting: Service,
) -> None:
    more = MAX_CONNECTIONS + 300
    lasting.ask(preview())
    before = lasting.memory()
    with ExitStack() as lines:
        for number in range(more):
            head = b"POST /v1/preview HTTP/1.1\r\nHost: x\r\n"
            lines.enter_context(lasting.connect(head))
            if number % 100 == 0:
                (answer,) = lasting.ask(HEALTH)
                assert answer.status == 200
        (answer,) = lasting.ask(preview())
        assert answer.status == 200
        assert lasting.memory() - before < 100


@pytest.mark.long
def test_addresses_can_be_left_out_of_the_log(lasting: Service) -> None:
    (well,) = lasting.ask(b"GET /healthz?name=Ada HTTP/1.1\r\nHost: x\r\n\r\n")
    (nonsense,) = lasting.ask(b"NONSENSE\r\n\r\n")
    expected = [
        f'INFO:     - - "GET /healthz HTTP/1.1" 200 OK [{well.headers["x-request-id"]}]',
        f'INFO:     - - "- - HTTP/1.1" 400 Bad Request [{nonsense.json()["request_id"]}]',
    ]
    # A line may come later than its answer.
    until(lambda: lasting.log.count(nonsense.json()["request_id"]) > 0)
    requests = [line for line in lasting.log.splitlines() if "HTTP/1.1" in line]
    assert requests[-2:] == expected
    assert "127.0.0.1" not in "".join(requests)
    assert "Ada" not in lasting.log


@pytest.mark.long
def test_a_port_in_use_is_reported(lasting: Service, tmp_path: Path) -> None:
    with (
        pytest.raises(AssertionError, match=r"(?i)address already in use"),
        service(tmp_path, "--port", str(lasting.port), "--workers", "2"),
    ):
        pass
