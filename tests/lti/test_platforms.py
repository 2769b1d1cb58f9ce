"""The operators' page of registered platforms."""

from dh_grader.lti import LTI_PROBLEMS, LtiError, cause_without_values
from dh_grader.translations import LANGUAGES, say, told

from tests.lti.conftest import hidden
from tests.lti.scores.conftest import Journey
from tests.lti.scores.conftest import journey as journey

PAGE = "/tutor/platforms"
CHECK = f"{PAGE}/moodle/check"


def test_the_page_lists_registrations_and_keys(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor()

    def shown() -> str:
        page = tool.send("GET", PAGE, headers=tutor)
        assert page.status_code == 200, page.text
        return page.text

    assert "<td>never</td>" in shown()
    assert "Last refusal" not in shown()
    journey.launch("ada")
    tool.platform.habits.append(lambda claims: claims.update(aud="somebody else"))
    assert tool.launch("ada").status_code == 403
    page = shown()
    assert "<td>never</td>" not in page
    assert "Last refusal" in page
    for value in (tool.platform.address, "client-1", "deployment-1", "/lti/jwks.json", "/token"):
        assert value in page
    [key] = tool.send("GET", "/lti/jwks.json").json()["keys"]
    assert key["kid"] in page
    home = tool.send("GET", "/tutor", headers=tutor).text
    assert 'href="tutor/platforms"' in home


def test_a_registration_is_tested_by_page(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor()
    page = tool.send("POST", CHECK, headers=tutor).text
    assert "OK: Access token: the platform gives one for scores" in page
    assert "OK: Keys of the platform: 1 of 1 can be used" in page
    assert "Wrong" not in page
    tool.platform.keys.clear()
    journey.gradebook.token_trouble = (400, {})
    page = tool.send("POST", CHECK, headers=tutor).text
    assert page.count("Wrong:") == 2
    assert "the status is 400" in page
    for name in ("another", "A%00"):
        unknown = tool.send("POST", f"{PAGE}/{name}/check", headers=tutor)
        assert unknown.status_code in (404, 422)


def test_the_page_and_the_test_are_in_the_readers_language(journey: Journey) -> None:
    tool, tutor = journey.tool, journey.tutor() | {"accept-language": "de"}
    page = tool.send("POST", CHECK, headers=tutor)
    assert page.headers["content-language"] == "de"
    assert "Zugriffstoken: Die Plattform gibt eines für Punkte" in page.text
    assert "Öffentliche Schlüssel" in page.text
    assert "Letzter Start: nie" in page.text
    tool.platform.habits.append(lambda claims: claims.update(iss="https://else.example"))
    assert tool.launch("ada").status_code == 403
    page = tool.send("GET", PAGE, headers=tutor)
    assert "UTC: Das id_token ist von einem anderen Aussteller." in page.text


def test_a_tutor_of_one_course_sees_no_registrations(journey: Journey) -> None:
    tool = journey.tool
    ticket = hidden(tool.launch("turing").text, "ticket")
    opened = tool.send("POST", "/lti/session", data={"ticket": ticket})
    session = {"cookie": opened.headers["set-cookie"].partition(";")[0]}
    for method, path in (("GET", PAGE), ("POST", CHECK)):
        assert tool.send(method, path, headers=session).status_code == 403
    assert "tutor/platforms" not in tool.send("GET", "/tutor", headers=session).text


def test_every_cause_is_in_each_language() -> None:
    for code in LANGUAGES.keys() - {"en"}:
        translation = LANGUAGES[code].translation
        for cause in map(cause_without_values, LTI_PROBLEMS):
            assert told(cause, translation) != cause, (code, cause)


def test_a_cause_has_its_values_and_their_translation() -> None:
    refused = LtiError("keys-unreachable", reason=say("the answer is not JSON"))
    assert str(refused) == "The keys of the platform cannot be read: the answer is not JSON"
    expected = "Die Schlüssel der Plattform sind nicht lesbar: die Antwort ist kein JSON"
    assert told(refused.args[0], LANGUAGES["de"].translation) == expected
    long = LtiError("platform-error", error="x" * 1000)
    assert str(long) == f"The platform answered with the error {'x' * 200}."


def test_a_cause_without_its_values_is_a_sentence() -> None:
    cause = cause_without_values("unknown-platform")
    assert cause == "No registration has the issuer … and this client id."
    assert (
        told(cause, LANGUAGES["de"].translation)
        == "Keine Registrierung hat den Aussteller … und diese Client-ID."
    )
    assert cause_without_values("of-an-older-version") == "of-an-older-version"
