"""Test the tutors' list of sent scores."""

import pytest
from dh_grader.lti.fetching import FetchError
from dh_grader.lti.grade_services import LaterError, problem_told
from dh_grader.translations import ENGLISH, language_named, say

from tests.cli.conftest import Run
from tests.cli.conftest import run as run
from tests.lti.scores.conftest import Journey


def refused_and_sent(journey: Journey) -> str:
    for user in ("ada", "grace"):
        journey.hand_in(user)
    journey.gradebook.enrolled = {"user grace"}
    journey.send()
    return journey.place("ada")[0]


def test_a_tutor_sees_why_and_sends_again(journey: Journey) -> None:
    course = refused_and_sent(journey)
    path = f"/v1/courses/{course}/scores"
    listed = journey.tool.send("GET", path, headers=journey.tutor()).json()["scores"]
    by_learner = {each["learner"]: each for each in listed}
    refused, sent = by_learner[journey.learner("ada")], by_learner[journey.learner("grace")]
    assert (sent["state"], sent["max_points"]) == ("sent", 10)
    assert sent["sent_points"] == pytest.approx(journey.total("grace"))
    assert refused["state"] == "refused"
    assert "status 400" in refused["problem"]
    failed = journey.tool.send("GET", f"{path}?failed=true", headers=journey.tutor()).json()
    assert [each["learner"] for each in failed["scores"]] == [journey.learner("ada")]
    # Only those that failed, then all of one learner.
    journey.gradebook.enrolled = None
    assert journey.post(f"courses/{course}/scores/send", failed=True) == {"queued": 1}
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"ada", "grace"}
    grace = journey.learner("grace")
    assert journey.post(f"courses/{course}/scores/send", learner=grace) == {"queued": 1}
    journey.gradebook.items["1"].grades.clear()
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"grace"}


def test_the_pages_show_it(journey: Journey) -> None:
    course = refused_and_sent(journey)
    _, assignment = journey.place("ada")
    for path in (
        f"/tutor/courses/{course}/assignments/{assignment}",
        f"/tutor/courses/{course}/learner?learner={journey.learner('ada')}",
    ):
        page = journey.tool.send("GET", path, headers=journey.tutor())
        assert page.status_code == 200, page.text
        assert "Sent to the learning platform" in page.text
        assert "refused: The platform refuses the score (status 400)." in page.text
        assert "Send again" in page.text


def test_problems_are_told_in_the_language_of_the_reader(journey: Journey) -> None:
    course = refused_and_sent(journey)
    german = {**journey.tutor(), "accept-language": "de"}
    path = f"/v1/courses/{course}/scores?failed=true"
    [score] = journey.tool.send("GET", path, headers=german).json()["scores"]
    assert score["problem"].startswith("Die Plattform lehnt die Punkte ab (Status 400).")
    reason = FetchError(say("the status is {status}", status=503))
    stored = LaterError("token-refused", reason=reason).stored
    assert problem_told(stored, language_named("de") or ENGLISH) == (
        "Die Plattform gibt kein Zugriffstoken: der Status ist 503"
    )


@pytest.mark.long
def test_the_command(journey: Journey, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    course = refused_and_sent(journey)
    monkeypatch.setenv("DH_GRADER_DATABASE", journey.tool.url)
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 4)
    lines = run("lti", "scores", course).output.splitlines()
    assert len(lines) == 2
    [line] = run("lti", "scores", course, "--failed").output.splitlines()
    assert "refused" in line
    assert journey.learner("ada") in line
    again = run("lti", "scores", course, "--failed", "--again")
    assert again.output == "Scores that are sent again: 1.\n"
    assert run("lti", "scores", "nothing").exit_code == 2
    checked = run("lti", "check", "moodle")
    assert "the platform gives one for scores" in checked.output
    journey.gradebook.token_trouble = (400, {})
    checked = run("lti", "check", "moodle")
    assert checked.exit_code == 1
    assert "the status is 400" in checked.output
