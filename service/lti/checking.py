"""The self-test of a platform's registration: keys, clocks, access token and last launch."""

import json
from collections.abc import Iterator
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from http import HTTPStatus
from typing import Final, NamedTuple

from service.lti.fetching import FetchError, answer, content
from service.lti.own_keys import SigningKey
from service.lti.platform_keys import usable_keys
from service.lti.problems import cause_without_values
from service.lti.registrations import Registration
from service.lti.scores.access_tokens import fetched_token
from service.lti.scores.line_items import SEND
from service.lti.scores.score_problems import ScoreError
from service.translations import say

# The greatest difference of clocks (seconds): messages may come from ten seconds ahead.
_CLOCKS: Final = 10.0


class CheckLine(NamedTuple):
    """A line of the self-test; ``is_fine`` is None if the line only informs."""

    is_fine: bool | None
    text: str


def check_registration(registration: Registration, key: SigningKey) -> Iterator[CheckLine]:
    """Yield the lines of the self-test, which asks the platform for keys and an access token."""
    try:
        with answer(registration.jwks_url, local=registration.is_development) as response:
            if response.status_code != HTTPStatus.OK:
                raise FetchError(say("the status is {status}", status=response.status_code))
            try:
                keys = usable_keys(json.loads(content(response)))
            except (ValueError, RecursionError) as error:
                raise FetchError(say("the answer is not JSON")) from error
            date = response.headers.get("date")
    except FetchError as error:
        yield CheckLine(False, say("Keys of the platform: {reason}", reason=error.args[0]))
    else:
        usable = sum(key is not None for key in keys.values())
        count = len(keys)
        said = say("Keys of the platform: {usable} of {all} can be used", usable=usable, all=count)
        yield CheckLine(usable > 0, said)
        yield _clocks(date)
    yield _token(registration, key)
    launched = registration.launched_at
    told = f"{launched:%Y-%m-%d %H:%M} UTC" if launched else say("never")
    yield CheckLine(None, say("Last launch: {when}", when=told))
    if refusal := last_refusal(registration):
        yield CheckLine(None, say("Last refusal: {refusal}", refusal=refusal))


def last_refusal(registration: Registration) -> str:
    """Return when and why a launch was last refused, or "" if none was refused."""
    if registration.refused_at is None:
        return ""
    moment = f"{registration.refused_at:%Y-%m-%d %H:%M} UTC"
    return say(
        "{moment}: {cause}", moment=moment, cause=cause_without_values(registration.refusal or "")
    )


def _token(registration: Registration, key: SigningKey) -> CheckLine:
    if registration.token_url is None:
        return CheckLine(
            None, say("Access token: no token address is registered; no scores are sent")
        )
    try:
        fetched_token(registration, SEND, key, datetime.now(UTC))
    except ScoreError as error:
        return CheckLine(False, say("Access token: {reason}", reason=error.args[0]))
    return CheckLine(True, say("Access token: the platform gives one for scores"))


def _clocks(date: str | None) -> CheckLine:
    try:
        theirs = parsedate_to_datetime(date or "")
        apart = abs((datetime.now(UTC) - theirs).total_seconds())
    except (ValueError, TypeError):
        return CheckLine(None, say("Clocks: the platform does not tell its time"))
    return CheckLine(apart <= _CLOCKS, say("Clocks: {seconds} s apart", seconds=f"{apart:.0f}"))
