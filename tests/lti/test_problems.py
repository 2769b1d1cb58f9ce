"""The causes of refused launches, in the language of those who run the service."""

from service.lti.problems import LTI_PROBLEMS, LtiError, cause_without_values
from service.translations import LANGUAGES, say, told

GERMAN = LANGUAGES["de"].translation


def test_every_cause_is_in_each_language() -> None:
    for code in LANGUAGES.keys() - {"en"}:
        translation = LANGUAGES[code].translation
        for cause in map(cause_without_values, LTI_PROBLEMS):
            assert told(cause, translation) != cause, (code, cause)


def test_a_cause_has_its_values_and_their_translation() -> None:
    refused = LtiError("keys-unreachable", reason=say("the answer is not JSON"))
    assert str(refused) == "The keys of the platform cannot be read: the answer is not JSON"
    expected = "Die Schlüssel der Plattform sind nicht lesbar: die Antwort ist kein JSON"
    assert told(refused.args[0], GERMAN) == expected
    long = LtiError("platform-error", error="x" * 1000)
    assert str(long) == f"The platform answered with the error {'x' * 200}."


def test_a_cause_without_its_values_is_a_sentence() -> None:
    cause = cause_without_values("unknown-platform")
    assert cause == "No registration has the issuer … and this client id."
    assert told(cause, GERMAN) == "Keine Registrierung hat den Aussteller … und diese Client-ID."
    assert cause_without_values("of-an-older-version") == "of-an-older-version"
