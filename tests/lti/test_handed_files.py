"""Grade files that students submit at the platform."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from html import unescape
from typing import Any

import httpx
import jwt
import pytest
from dh_grader.access import Scope, new_key_text
from dh_grader.access.key_ring import add_key
from dh_grader.catalogue import Exercise
from dh_grader.lti import handed_files as queue
from dh_grader.lti.fetching import published_keys
from dh_grader.lti.handed_files import FileReporting, missing_counts, missing_reports
from dh_grader.lti.outbox import BackgroundSending
from dh_grader.lti.registrations import registration, remove_registration
from dh_grader.store.results import forget
from dh_grader.store.tables import contexts, handed_files
from dh_grader.translations import ENGLISH
from sqlalchemy import select

from tests.access.kept_services import SECRET
from tests.lti.conftest import Clock, Tool, hidden
from tests.lti.file_store import LTI, FileStore
from tests.lti.platform import DL, MEMBER, deep_linking, public_jwk, rsa_key
from tests.lti.test_outbox import _wait

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
# Both rows are right, the second one has a wrong length, and nothing can be read.
RIGHT = b"a,alpha,d,theta\na1,0,0,q1\na2,0,0,q2\n"
WRONG = b"a,alpha,d,theta\na1,0,0,q1\na1,0,0,q2\n"
OTHER_KEY = rsa_key()


@dataclass
class Course:
    """An assignment at the platform whose files the service grades."""

    tool: Tool
    clock: Clock
    reporting: FileReporting

    @property
    def store(self) -> FileStore:
        return self.tool.platform.files

    def notify(self, *claims: dict[str, Any], key: Any = None) -> httpx.Response:
        tokens = [self.tool.platform.signed(each, key) for each in claims]
        body = {"notices": [{"jwt": each} for each in tokens]}
        return self.tool.send("POST", "/lti/notices", json=body)

    def hand_in(self, user: str = "ada", notice: str = "notice-1", **files: bytes) -> None:
        named = {name.replace("_", "."): data for name, data in files.items()}
        self.store.files |= named
        answer = self.notify(self.store.notice(*named, user=user, notice=notice))
        assert (answer.status_code, answer.json()) == (200, {})

    def grade(self) -> list[dict[str, Any]]:
        while self.reporting.send_next():
            pass
        return self.store.reports

    def rows(self) -> list[Any]:
        found: list[Any] = self.tool.do(lambda it: it.execute(select(handed_files)).all())
        return found

    def review(self, user: str, asset: str = "id of table.csv", of: str = "ada") -> httpx.Response:
        def asked(claims: dict[str, Any]) -> None:
            claims[f"{LTI}message_type"] = "LtiReportReviewRequest"
            del claims[f"{LTI}resource_link"]
            claims[f"{LTI}submission"] = {"id": f"submission of {of}"}
            claims[f"{LTI}asset"] = {"id": asset}
            claims[f"{LTI}assetreport_type"] = "dh-grader"

        self.tool.platform.habits[:] = [asked]
        return self.tool.launch(user)


@pytest.fixture
def course(tool: Tool, catalogue: Mapping[str, Exercise]) -> Course:
    clock = Clock()
    gradebook = tool.platform.gradebook
    gradebook.now = clock.now
    gradebook.own_keys = lambda: tool.do(published_keys)
    engine = tool.store.engine
    return Course(tool, clock, FileReporting(engine, SECRET, catalogue, clock.now, lambda: 1.0))


@KINDS
def test_a_tutor_chooses_and_a_file_is_graded(course: Course) -> None:
    tool, store = course.tool, course.store
    address = tool.platform.address
    service = {"platform_notification_service_url": f"{address}/handlers"}
    asked = deep_linking(f"{address}/return", accept_types=["ltiAssetProcessor"])
    tool.platform.habits[:] = [
        asked,
        lambda claims: claims.update({f"{LTI}platformnotificationservice": service}),
    ]
    page = tool.launch("turing").text
    assert "Files that students hand in at your platform" in page
    assert 'name="due"' not in page
    chosen = {"exercise": "planar-rr", "points:planar-rr": "10", "title": "Arm", "action": "add"}
    ticket = hidden(page, "ticket")
    store.trouble["noticehandlers"] = [403, 403]
    sent = tool.send("POST", "/lti/links", data={"ticket": ticket, **chosen})
    assert "does not let this service read files of students" in sent.text
    store.trouble.clear()
    sent = tool.send("POST", "/lti/links", data={"ticket": ticket, **chosen})
    assert store.handlers == {
        "LtiAssetProcessorSubmissionNotice": f"{tool.platform.tool}/lti/notices"
    }
    claims = jwt.decode(hidden(sent.text, "JWT"), options={"verify_signature": False})
    [item] = claims[f"{DL}content_items"]
    assert (item["type"], item["title"]) == ("ltiAssetProcessor", "Arm")
    assert item["custom"] == {"exercise": "planar-rr=10", "locale": "en"}
    course.hand_in(table_csv=RIGHT)
    [report] = course.grade()
    parts = tool.send("GET", "/v1/exercises/planar-rr").json()["parts"]
    worth = {each["id"]: each["points"] for each in parts}
    points = 10 * worth["table"] / sum(worth.values())
    assert report["assetId"] == "id of table.csv"
    assert (report["scoreGiven"], report["scoreMaximum"]) == (pytest.approx(points), 10)
    assert report["result"] == f"{points:.2f}/10"
    assert report["processingProgress"] == "Processed"
    assert report["type"] in item["report"]["supportedTypes"]
    assert "Punkte" in report["indicationAlt"]
    assert re.fullmatch(r"#[0-9A-F]{6}", report["indicationColor"])
    [row] = course.rows()
    assert (row.state, row.refusal) == ("sent", None)
    assert "user ada" not in str(row)
    assert "q1" not in str(row)


@pytest.mark.long
def test_students_see_their_own_report_and_teachers_all(course: Course) -> None:
    course.hand_in(table_csv=WRONG)
    course.grade()
    page = course.review("ada")
    assert page.status_code == 200
    assert "table.csv" in page.text
    policy = page.headers["content-security-policy"]
    [digest] = re.findall(r"style-src '(sha256-[^']+)'", unescape(page.text))
    assert f"style-src '{digest}'" in policy
    assert course.tool.platform.address in policy
    tutor = course.review("turing")
    assert tutor.status_code == 200
    for user, asset, of, told in (
        ("grace", "id of table.csv", "ada", "foreign-report"),
        ("parent", "id of table.csv", "ada", "foreign-report"),
        ("preview", "id of table.csv", "ada", "foreign-report"),
        ("", "id of table.csv", "ada", "foreign-report"),
        ("turing", "id of another.csv", "ada", "unknown-report"),
        ("turing", "id of table.csv", "grace", "unknown-report"),
        ("turing", "", "ada", "bad-claim"),
    ):
        refused = course.review(user, asset, of)
        assert (user, refused.status_code) == (user, 403)
        assert told in refused.text
    del course.store.files["table.csv"]
    assert "file-unreadable" in course.review("turing").text


def test_the_settings_page_says_how_to_choose_other_exercises(course: Course) -> None:
    def asked(claims: dict[str, Any]) -> None:
        claims[f"{LTI}message_type"] = "LtiAssetProcessorSettingsRequest"
        del claims[f"{LTI}resource_link"]

    course.tool.platform.habits[:] = [asked]
    page = course.tool.launch("turing")
    assert page.status_code == 200
    assert "remove DH Grader from the assignment" in page.text


def test_several_files_are_graded_together(course: Course) -> None:
    course.hand_in(table_csv=RIGHT, photo_png=b"\x89PNG\r\n\x1a\n\0", huge_csv=b"1" * 300_000)
    reports = {each["assetId"].removeprefix("id of "): each for each in course.grade()}
    assert reports["table.csv"]["processingProgress"] == "Processed"
    assert reports["photo.png"]["errorCode"] == "UNSUPPORTED_ASSET_TYPE"
    assert reports["huge.csv"]["errorCode"] == "ASSET_TOO_LARGE"
    assert {each["processingProgress"] for each in reports.values()} == {"Processed", "Failed"}


def test_a_text_that_was_typed_at_the_platform_is_read(course: Course) -> None:
    # Platforms send a typed text as a web page without a file name.
    #
    # The service can grade the text if the assignment has only one exercise with one part.
    course.store.files["text"] = (
        b"<table><tr><td>a1</td><td>0</td><td>0</td><td>q1</td></tr></table>"
    )
    claims = course.store.notice("text")
    asset = claims[f"{LTI}assetservice"]["assets"][0]
    del asset["filename"]
    asset["content_type"] = "text/html"
    assert course.notify(claims).status_code == 200
    [report] = course.grade()
    # The exercise has several parts, and nothing says which one it answers.
    assert report["errorCode"] == "UNSUPPORTED_ASSET_TYPE"
    assert "answer.html" in report["comment"]


def test_hostile_names_and_contents_do_no_harm(course: Course) -> None:
    names = (
        "../../etc/passwd",
        "/etc",
        "dh_grader",
        "..",
        "a\0b.csv",
        "x" * 3000,
        "table.csv",
        "TABLE.CSV",
    )
    claims = course.store.notice(*[f"f{i}" for i in range(len(names))])
    for i, (each, name) in enumerate(
        zip(claims[f"{LTI}assetservice"]["assets"], names, strict=True)
    ):
        course.store.files[f"f{i}"] = b'{"answers": {"table": [[' if i % 2 else b"\xff\xfe\0"
        each["filename"] = name
        del each["sha256_checksum"]
    assert course.notify(claims).status_code == 200
    reports = course.grade()
    assert len(reports) == len(names)
    failed = [each for each in reports if each["processingProgress"] == "Failed"]
    assert len(failed) >= 6
    # In the others, which have a known name, nothing can be read.
    others = [each for each in reports if each not in failed]
    assert {("scoreGiven" in each, each["priority"]) for each in others} <= {(False, 3)}
    assert [each.state for each in course.rows()] == ["sent"]


def test_the_report_says_that_the_exercise_is_unknown(course: Course) -> None:
    course.store.files["table.csv"] = RIGHT
    custom = {"exercise": "no-such-robot=10"}
    course.notify(course.store.notice("table.csv") | {f"{LTI}custom": custom})
    [report] = course.grade()
    assert (report["processingProgress"], report["errorCode"]) == ("Failed", "UNKNOWN_EXERCISE")


def test_a_redirect_gets_no_token(course: Course) -> None:
    store, port = course.store, course.tool.platform.port
    store.other_host = lambda name: f"http://localhost:{port}/storage/{name}"
    course.hand_in(table_csv=RIGHT)
    [report] = course.grade()
    assert report["processingProgress"] == "Processed"
    assert store.elsewhere == [None]


def test_a_changed_file_is_not_graded(course: Course) -> None:
    course.hand_in(table_csv=RIGHT)
    course.store.files["table.csv"] = WRONG
    [report] = course.grade()
    assert report["errorCode"] == "DOWNLOAD_FAILED"
    assert report["comment"] == "ihre Prüfsumme ist eine andere"


def test_nothing_is_fetched_from_a_private_address(course: Course) -> None:
    claims = course.store.notice("table.csv")
    for place, name, value in (
        (claims[f"{LTI}assetservice"]["assets"][0], "url", "http://169.254.169.254/latest"),
        (claims[f"{LTI}assetreport"], "report_url", "file:///etc/passwd"),
    ):
        before, place[name] = place[name], value
        refused = course.notify(claims)
        assert (refused.status_code, refused.json()) == (
            403,
            {"errors": [{"error": "bad-address"}]},
        )
        place[name] = before
    course.store.files["table.csv"] = RIGHT
    course.store.other_host = lambda _: "https://169.254.169.254/latest"
    assert course.notify(claims).status_code == 200
    [report] = course.grade()
    assert (report["errorCode"], "private" in report["comment"]) == ("DOWNLOAD_FAILED", True)


@KINDS
def test_a_platform_in_trouble_gets_its_reports_later(course: Course) -> None:
    store = course.store
    course.hand_in(table_csv=RIGHT)
    for scope, status in (("asset.readonly", 503), ("report", 429), ("report", 500)):
        store.trouble[scope] = [status]
        assert course.grade() == []
        assert course.reporting.next_due() is not None
        course.clock.go_on(minutes=10)
    # The token is not accepted any more: another one is asked for.
    store.trouble["report"] = [401]
    assert len(course.grade()) == 1
    assert course.reporting.next_due() is None
    store.trouble["report"] = [404] * 9
    course.hand_in("grace", "notice-2", table_csv=RIGHT)
    course.grade()
    assert [each.state for each in course.rows()] == ["sent", "refused"]


@pytest.mark.long
def test_tutors_see_which_reports_did_not_arrive(course: Course) -> None:
    tool, store = course.tool, course.store
    for user in ("ada", "grace"):
        tool.launch(user)
    course.hand_in(table_csv=RIGHT)
    store.trouble["report"] = [404]
    course.grade()
    store.trouble["report"] = [503]
    course.hand_in("grace", "notice-2", pose_csv=RIGHT)
    course.grade()
    # The same student in another course of the platform, and a notice that names no course.
    for number, more in ((3, {"id": "course-2"}), (4, None)):
        store.trouble["report"] = [404]
        claims = store.notice("table.csv", notice=f"notice-{number}")
        assert course.notify(claims | {f"{LTI}context": more}).status_code == 200
        course.grade()
    here = tool.do(lambda it: it.scalar(select(contexts.c.course)))
    waiting, refused = tool.do(lambda it: missing_reports(it, here, ENGLISH))
    assert (refused.files, refused.next_try_at) == (["table.csv"], None)
    assert refused.problem == "The platform refuses the report (status 404)."
    assert (waiting.files, waiting.next_try_at is None) == (["pose.csv"], False)
    assert tool.do(missing_counts) == {"moodle": 4}
    ada = refused.learner
    key = tutor_key(tool)
    headers = {"authorization": f"Bearer {key}"}
    pages = {
        f"/tutor/courses/{here}": ["table.csv", "pose.csv"],
        f"/tutor/courses/{here}/learner?learner={ada}": ["table.csv"],
        "/tutor/platforms": ["Did not arrive: 4"],
    }
    for path, expected in pages.items():
        page = tool.send("GET", path, headers=headers).text
        assert re.findall(r"table\.csv|pose\.csv|Did not arrive: 4", page)[::-1] == expected, path


def tutor_key(tool: Tool) -> str:
    """Return a key of a tutor of all courses."""
    text, now = new_key_text(), datetime.now(UTC)
    digest, end = SECRET.key_digest(text), now + timedelta(days=1)
    tool.do(lambda it: add_key(it, "t", digest, set(Scope), None, now, end))
    return text


@pytest.mark.long
def test_after_three_days_files_are_given_up(course: Course) -> None:
    course.hand_in(table_csv=RIGHT)
    course.store.trouble["report"] = [503] * 99
    for _ in range(40):
        course.grade()
        course.clock.go_on(hours=4)
    [row] = course.rows()
    assert row.state == "refused"
    assert row.tries < 40


def test_a_killed_process_reports_again(course: Course) -> None:
    # The platform accepts the second report, because this report has a later time stamp.
    course.hand_in(table_csv=RIGHT)
    taken = course.tool.do(lambda it: queue.take(it, course.clock.now()))
    assert taken is not None
    assert course.grade() == []
    course.clock.go_on(minutes=6)
    assert len(course.grade()) == 1
    course.tool.do(lambda it: queue.note_later(it, taken.number, course.clock.now(), ""))
    course.tool.do(lambda it: it.execute(handed_files.update().values(state="waiting")))
    course.clock.go_on(seconds=1)
    assert len(course.grade()) == 2
    # A report that is newer than ours stays, and ours is done.
    course.store.reports[-1]["timestamp"] = "2999-01-01T00:00:00Z"
    course.tool.do(lambda it: it.execute(handed_files.update().values(state="waiting")))
    assert len(course.grade()) == 2
    assert course.rows()[0].state == "sent"


def test_the_service_grades_what_it_has_committed(course: Course) -> None:
    engine = course.tool.store.engine
    sending = BackgroundSending(engine, course.reporting, queue.QUEUED)
    sending.start()
    try:
        course.hand_in(table_csv=RIGHT)
        _wait(lambda: len(course.store.reports) == 1)
    finally:
        sending.close()


def put(name: str, value: Any) -> Callable[[dict[str, Any]], None]:
    return lambda claims: claims.update({name: value})


def without(name: str) -> Callable[[dict[str, Any]], None]:
    return lambda claims: claims.pop(name)


NOW = int(datetime.now(UTC).timestamp())
FORGED: list[tuple[Callable[[dict[str, Any]], None], str]] = [
    (put("iss", "https://evil.example"), "unknown-platform"),
    (without("iss"), "wrong-issuer"),
    (put("aud", "client-2"), "wrong-audience"),
    (put("iss", "\ud800"), "wrong-issuer"),
    (put("aud", "\ud800"), "wrong-audience"),
    (put("azp", "client-2"), "unknown-platform"),
    (put("aud", ["client-2", "client-3"]), "wrong-audience"),
    (without("exp"), "no-expiry"),
    (put("exp", NOW - 60), "expired"),
    (without("iat"), "no-issue-time"),
    (put("iat", NOW + 86_400), "issued-later"),
    (put("iat", NOW - 7200), "issued-before"),
    (put(f"{LTI}version", "1.1"), "wrong-version"),
    (without(f"{LTI}notice"), "wrong-notice"),
    (put(f"{LTI}notice", {"id": "n", "type": "LtiContextCopyNotice"}), "wrong-notice"),
    (put(f"{LTI}notice", {"type": "LtiAssetProcessorSubmissionNotice"}), "bad-claim"),
    (without(f"{LTI}deployment_id"), "no-deployment"),
    (put(f"{LTI}deployment_id", "other"), "unknown-deployment"),
    (without(f"{LTI}submission"), "bad-claim"),
    (put(f"{LTI}for_user", {"user_id": 7}), "bad-claim"),
    (without(f"{LTI}assetservice"), "no-files"),
    (put(f"{LTI}assetservice", {"assets": "x"}), "no-files"),
    (put(f"{LTI}assetservice", {"assets": [{"asset_id": "a"}]}), "no-files"),
    (without(f"{LTI}assetreport"), "no-files"),
]  # fmt: skip


@pytest.mark.long
def test_forged_notices_are_refused(course: Course) -> None:
    course.store.files["table.csv"] = RIGHT
    told = []
    for change, _ in FORGED:
        claims = course.store.notice("table.csv")
        change(claims)
        answer = course.notify(claims)
        assert answer.status_code == 403
        [error] = answer.json()["errors"]
        told.append(error["error"])
    assert told == [expected for _, expected in FORGED]
    right = course.store.notice("table.csv")
    keyed = jwt.encode(right, "x" * 40, "HS256", {"kid": "key-1"})
    launch = course.tool.platform.signed(course.tool.platform.claims("ada", "link-1", "n"))
    for token, expected in (
        (course.tool.platform.signed(right, OTHER_KEY), "wrong-signature"),
        (
            course.tool.platform.signed(right, OTHER_KEY, jwk=public_jwk(OTHER_KEY, "key-1")),
            "wrong-signature",
        ),
        (course.tool.platform.signed(right, kid="evil"), "unknown-key"),
        (keyed, "wrong-algorithm"),
        (launch, "wrong-notice"),
        ("x.y.z", "token-malformed"),
        ("", "no-token"),
    ):
        body = {"notices": [{"jwt": token}]}
        answer = course.tool.send("POST", "/lti/notices", json=body)
        assert answer.json()["errors"] == [{"error": expected}]
    bodies: list[Any] = [
        {},
        {"notices": []},
        {"notices": [{"jwt": 1}]},
        {"notices": [{"jwt": "x"}] * 51},
    ]
    for body in bodies:
        assert course.tool.send("POST", "/lti/notices", json=body).status_code == 422
    assert course.rows() == []
    assert course.grade() == []
    # One that is refused does not keep out the others, and a copy changes nothing.
    copy = course.store.notice("table.csv")
    answer = course.notify(copy, course.store.notice("table.csv") | {"azp": "client-2"}, copy)
    assert answer.json()["errors"] == [{"error": "unknown-platform"}]
    assert course.tool.do(lambda it: registration(it, "moodle")).refusal == "wrong-notice"
    assert len(course.grade()) == 1
    assert course.notify(copy).status_code == 200
    assert len(course.grade()) == 1
    # A notice opens no page.
    begun = course.tool.login()
    token = course.tool.platform.signed(copy | {"nonce": begun.asked["nonce"]})
    assert course.tool.post(begun.asked["state"], token, begun.cookies).status_code == 403


def test_a_hello_notice_is_accepted(course: Course) -> None:
    hello = {f"{LTI}notice": {"id": "n", "type": "LtiHelloWorldNotice"}}
    assert course.notify(course.store.notice() | hello).status_code == 200
    assert course.rows() == []


def test_a_forgotten_learner_and_a_removed_platform_leave_no_addresses(course: Course) -> None:
    course.hand_in(table_csv=RIGHT)
    [row] = course.rows()
    course.tool.do(lambda it: forget(it, row.learner))
    assert course.rows() == []
    course.hand_in(table_csv=RIGHT)
    course.tool.do(lambda it: remove_registration(it, "moodle"))
    assert course.rows() == []


def test_addresses_are_kept_for_four_hundred_days(course: Course) -> None:
    course.hand_in(table_csv=RIGHT)
    old = datetime(2020, 1, 1, tzinfo=UTC)
    course.tool.do(lambda it: it.execute(handed_files.update().values(received_at=old)))
    course.hand_in("grace", "notice-2", table_csv=RIGHT)
    assert [each.notice for each in course.rows()] == ["notice-2"]


def test_learners_only_choose_nothing(course: Course) -> None:
    address = course.tool.platform.address
    asked = deep_linking(f"{address}/return", accept_types=["ltiAssetProcessor"])
    course.tool.platform.habits[:] = [asked]
    # The platform does not say where to ask for notices.
    assert "no-notices" in course.tool.launch("turing").text
    learner = [f"{MEMBER}#Learner"]
    course.tool.platform.habits.append(lambda claims: claims.update({f"{LTI}roles": learner}))
    service = {"platform_notification_service_url": "http://169.254.169.254/"}
    course.tool.platform.habits.append(
        lambda claims: claims.update({f"{LTI}platformnotificationservice": service})
    )
    assert "bad-address" in course.tool.launch("turing").text
    assert course.tool.do(lambda it: registration(it, "moodle")).launched_at is None
