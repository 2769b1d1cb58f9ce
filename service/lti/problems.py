"""The reasons why a launch is refused, in words for students and for operators."""

from collections.abc import Mapping
from string import Formatter
from typing import Final, NamedTuple

from service.translations import Sentence, say, template

# What the student can do.
_AGAIN: Final = say(
    "Go back to your course, reload the page there, and open the exercise once more."
)
_TEACHER: Final = say(
    "You have done nothing wrong. Tell your teacher, who passes the reference number on to the "
    "people that run this service."
)


class LtiProblem(NamedTuple):
    """Why a launch is refused. ``cause`` has placeholders in braces; ``advice`` is for students."""

    cause: str
    advice: str = _TEACHER


# By their names. The first ones are of logins, the others in the order in which they are checked.
LTI_PROBLEMS: Final[Mapping[str, LtiProblem]] = {
    "login-incomplete": LtiProblem(template("The login has no {name}.")),
    "login-too-long": LtiProblem(template("The field {name} of the login is too long.")),
    "unknown-platform": LtiProblem(
        template("No registration has the issuer {issuer} and this client id.")
    ),
    "several-platforms": LtiProblem(
        template(
            "Several registrations have the issuer {issuer}, and the login names no client id."
        )
    ),
    "foreign-target": LtiProblem(
        template("The login is for the address {target}, which is not ours.")
    ),
    "platform-error": LtiProblem(template("The platform answered with the error {error}."), _AGAIN),
    "no-state": LtiProblem(template("The message has no state."), _AGAIN),
    "unknown-state": LtiProblem(template("No login has this state, or it is over."), _AGAIN),
    "state-expired": LtiProblem(template("The login was begun more than ten minutes ago."), _AGAIN),
    "state-used": LtiProblem(
        template("The state was used already: the message is a copy."), _AGAIN
    ),
    "other-browser": LtiProblem(template("The login was begun in another browser."), _AGAIN),
    "binding-from-elsewhere": LtiProblem(
        template("The page of another site has sent the message."), _AGAIN
    ),
    "cookies-blocked": LtiProblem(
        template("The browser keeps no cookies, and the platform has no storage."),
        say(
            "Your browser does not accept cookies from this page. Allow them, or use another "
            "browser."
        ),
    ),
    "no-token": LtiProblem(template("The message has no id_token.")),
    "token-too-long": LtiProblem(template("The id_token is too long.")),
    "token-malformed": LtiProblem(template("The id_token is not a JSON Web Token.")),
    "wrong-algorithm": LtiProblem(template("The id_token is signed by {algorithm}, not by RS256.")),
    "no-key-id": LtiProblem(template("The id_token names no key (kid).")),
    "keys-unreachable": LtiProblem(
        template("The keys of the platform cannot be read: {reason}"), _AGAIN
    ),
    "unknown-key": LtiProblem(template("The platform has no key with the id in the id_token.")),
    "unusable-key": LtiProblem(
        template("The key of the platform is not an RSA key of 2048 bits or more.")
    ),
    "wrong-signature": LtiProblem(template("The signature of the id_token is wrong.")),
    "wrong-issuer": LtiProblem(template("The id_token is from another issuer.")),
    "wrong-audience": LtiProblem(template("The id_token is for another client id.")),
    "wrong-party": LtiProblem(template("The id_token is authorised for another client id (azp).")),
    "no-expiry": LtiProblem(template("The id_token has no expiry (exp).")),
    "expired": LtiProblem(template("The id_token has expired. Compare the clocks."), _AGAIN),
    "no-issue-time": LtiProblem(template("The id_token has no time of issue (iat).")),
    "issued-later": LtiProblem(
        template("The id_token is from the future. Compare the clocks."), _AGAIN
    ),
    "issued-before": LtiProblem(template("The id_token is older than an hour."), _AGAIN),
    "not-yet-valid": LtiProblem(
        template("The id_token is not valid yet (nbf). Compare the clocks."), _AGAIN
    ),
    "no-nonce": LtiProblem(template("The id_token has no nonce.")),
    "wrong-nonce": LtiProblem(
        template("The nonce of the id_token is that of another login."), _AGAIN
    ),
    "wrong-version": LtiProblem(template("The message is not of LTI version 1.3.0.")),
    "wrong-message": LtiProblem(template("Messages of the type {kind} are not known here.")),
    "no-deployment": LtiProblem(template("The message has no deployment id.")),
    "other-deployment": LtiProblem(template("The login was for another deployment.")),
    "unknown-deployment": LtiProblem(template("The deployment {deployment} is not registered.")),
    "no-target": LtiProblem(template("The message has no target_link_uri.")),
    "other-target": LtiProblem(template("The message is for another address than the login.")),
    "no-roles": LtiProblem(template("The message has no list of roles.")),
    "bad-user": LtiProblem(template("The user's id (sub) is empty, too long, or not a text.")),
    "no-context": LtiProblem(
        template("The message has no context: it was not opened from a course.")
    ),
    "no-resource-link": LtiProblem(template("The message has no resource link.")),
    "not-a-tutor": LtiProblem(template("Only tutors choose exercises, and the user is none.")),
    "no-linking-settings": LtiProblem(template("The message has no settings of deep linking.")),
    "no-return-address": LtiProblem(
        template("The settings of deep linking have no usable return address.")
    ),
    "foreign-return-address": LtiProblem(
        template("The return address {address} does not belong to the registered platform.")
    ),
    "no-links-accepted": LtiProblem(template("The platform does not accept links at this place.")),
    "no-notices": LtiProblem(
        template("The platform does not say how to be told of handed-in files.")
    ),
    "wrong-notice": LtiProblem(template("Notices of the type {kind} are not known here.")),
    "no-files": LtiProblem(
        template("The notice does not say which files were handed in, and where.")
    ),
    "bad-address": LtiProblem(template("The address {address} in the notice {reason}.")),
    "unknown-report": LtiProblem(template("No such file was handed in, or its report is too old.")),
    "foreign-report": LtiProblem(template("The report is on the file of another student.")),
    "file-unreadable": LtiProblem(
        template("The platform does not give the file: {reason}"), _AGAIN
    ),
    "bad-claim": LtiProblem(template("The claim {claim} does not have the right shape.")),
    "no-longer-registered": LtiProblem(template("The registration was removed after the login.")),
    "ticket-expired": LtiProblem(template("The page was open for too long."), _AGAIN),
    "no-secret": LtiProblem(template("The secret is not the one with which the keys were made.")),
}


class LtiError(Exception):
    """A launch that is refused; ``name`` is one of ``LTI_PROBLEMS``."""

    def __init__(self, name: str, /, **values: object) -> None:
        problem = LTI_PROBLEMS[name]
        self.name = name
        self.advice = problem.advice
        shown = {key: short_value(value) for key, value in values.items()}
        super().__init__(Sentence(problem.cause, shown))


def short_value(value: object) -> str:
    """Return a value for a message, as a translatable Sentence or as a short text."""
    said = value.args[0] if isinstance(value, Exception) and value.args else value
    return said if isinstance(said, Sentence) else str(value)[:200]


def cause_without_values(name: str) -> str:
    """Return the cause of the refusal ``name`` as a text, with "…" for each value."""
    problem = LTI_PROBLEMS.get(name)
    if problem is None:
        return name
    places = (place for _, place, _, _ in Formatter().parse(problem.cause) if place)
    return Sentence(problem.cause, dict.fromkeys(places, "…"))
