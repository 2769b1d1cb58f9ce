"""`dh-grader lti`: registered platforms, how they join, our keys, and the scores of a course.

What happens there is in ``dh_grader.lti``; this file knows options and messages.
"""

import json
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, TypeVar

import typer
from pydantic import ValidationError
from rich.cells import cell_len, set_cell_size
from sqlalchemy import Connection

from dh_grader.access import Secret
from dh_grader.cli.attempts import database, encodable
from dh_grader.cli.courses import CourseOption, changed
from dh_grader.cli.terminal import give_up, spoken, stdout, tell, tell_verdict, user_language
from dh_grader.contract.courses import SendAgainRequest
from dh_grader.formats.texts import number, visible
from dh_grader.lti import registrations
from dh_grader.lti.fetching import ensure_key, own_key_list, rotate, signing_key
from dh_grader.lti.joining import (
    LONGEST_DAYS,
    allow,
    canvas_configuration,
    check_registration,
    invite,
)
from dh_grader.lti.outbox import scores_of, send_again
from dh_grader.lti.registrations import (
    LtiError,
    NewRegistration,
    Registration,
    RegistrationError,
    unusable,
)
from dh_grader.lti.roster import RosterError, ask_for_roster, enrol_members, read_roster
from dh_grader.settings import load_settings
from dh_grader.store.database import in_transaction
from dh_grader.submissions.bodies import field_error
from dh_grader.translations import joined, say

# --- `dh-grader lti scores`: the scores of a course at its platform


def scores(
    course: CourseOption,
    failed: Annotated[
        bool, typer.Option("--failed", help="Only scores that were refused, or tried in vain.")
    ] = False,
    again: Annotated[bool, typer.Option("--again", help="Send them again.")] = False,
) -> None:
    """List the scores of a course that go to its platform, or send them again."""
    wanted, now = SendAgainRequest(failed=failed), datetime.now(UTC)
    if again:
        queued = changed(lambda it: send_again(it, course, wanted, now))
        tell(say("Scores that are sent again: {queued}.", queued=queued))
        return
    for each in changed(lambda it: scores_of(it, course, wanted, user_language())):
        points = "-" if each.sent_points is None else number(each.sent_points)
        at = f"{each.sent_at:%Y-%m-%d %H:%M} UTC" if each.sent_at else spoken(say("never sent"))
        line = [each.assignment, each.learner, f"{points} / {number(each.max_points)}", at]
        line += [each.state] + ([each.problem] if each.problem else [])
        stdout().print("  ".join(map(visible, line)), soft_wrap=True)


# --- `dh-grader lti invite`, `allow` and `canvas`: how platforms join


Address = Annotated[
    str | None,
    typer.Option(help="This service: https://grader.example.edu \\[DH_GRADER_PUBLIC_URL]"),
]


def invite_platform(
    name: Annotated[str, typer.Argument(help="The platform in words.", callback=encodable)],
    address: Address = None,
    zone: Annotated[str, typer.Option(help="The time zone of its courses.")] = "UTC",
    days: Annotated[int, typer.Option(min=1, max=LONGEST_DAYS, help="How long it is valid.")] = 7,
    hold: Annotated[
        bool, typer.Option("--hold", help="The platform launches only after `lti allow`.")
    ] = False,
) -> None:
    """Make a link by which a platform registers itself, once. Keep it secret until then."""
    now, own = datetime.now(UTC), own_address(address)
    with database(create=True) as engine:
        try:
            link = in_transaction(
                engine,
                lambda it: invite(it, name[:200], own, zone, now, days=days, waits=hold),
            )
        except RegistrationError as error:
            give_up(error)
    stdout().print(link, soft_wrap=True)


def allow_platform(
    registration: Annotated[
        str, typer.Argument(help="The id of a registration, as list shows it.", callback=encodable)
    ],
) -> None:
    """Let a platform launch that has registered itself by an invitation with --hold."""
    with database(create=False) as engine:
        try:
            in_transaction(engine, lambda it: allow(it, registration))
        except RegistrationError as error:
            give_up(error)
    tell(say("Allowed."))


def canvas(
    address: Address = None,
    files: Annotated[
        bool, typer.Option("--files", help="Also grade files that students hand in at Canvas.")
    ] = False,
) -> None:
    """Print the JSON configuration for a developer key of Canvas."""
    own = own_address(address)
    if reason := unusable(own, local=True):
        give_up(joined(": ", ["address", reason]))
    typer.echo(json.dumps(canvas_configuration(own, files=files), indent=2))


def own_address(option: str | None) -> str:
    """Return the address of this service, from the option or the setting; exit without both."""
    found = option or load_settings().public_url
    if found is None:
        give_up(say("Give the address of this service: set DH_GRADER_PUBLIC_URL, or --address."))
    return found.rstrip("/")


# --- `dh-grader lti`: all its commands; the registered platforms, and our keys for signing


R = TypeVar("R")

lti_commands = typer.Typer(
    help="LTI 1.3: platforms that launch courses, and the keys for them.",
    no_args_is_help=True,
    add_completion=False,
)
_keys = typer.Typer(help="The keys with which this service signs.", no_args_is_help=True)
lti_commands.add_typer(_keys, name="keys")
lti_commands.command("invite")(invite_platform)
lti_commands.command("allow")(allow_platform)
lti_commands.command("canvas")(canvas)
lti_commands.command("scores")(scores)

RegistrationId = Annotated[
    str, typer.Argument(help="The id of a registration, as list shows it.", callback=encodable)
]
Value = Annotated[str | None, typer.Option(callback=encodable, help="As the platform shows it.")]


@lti_commands.command("register")
def register(
    file: Annotated[
        Path | None, typer.Option(help="A JSON file with the values, instead of the options.")
    ] = None,
    registration: Annotated[
        str | None, typer.Option("--id", help="Small letters, digits, hyphens. \\[random]")
    ] = None,
    name: Annotated[str | None, typer.Option(help="The platform in words.")] = None,
    issuer: Value = None,
    client_id: Value = None,
    auth_url: Value = None,
    jwks_url: Value = None,
    token_url: Value = None,
    audience: Annotated[
        str | None, typer.Option(help="The audience of access tokens. \\[the token address]")
    ] = None,
    address: Address = None,
    zone: Annotated[str | None, typer.Option(help="The time zone of its courses. [UTC]")] = None,
    deployment: Annotated[
        list[str] | None, typer.Option(help="Only this deployment. Repeatable. \\[all]")
    ] = None,
    development: Annotated[
        bool, typer.Option(help="Allow a platform on this machine without HTTPS.")
    ] = False,
) -> None:
    """Register a platform with the values that it shows."""
    given: dict[str, Any] = {} if file is None else _values_in(file)
    options = {
        "id": registration,
        "name": name,
        "issuer": issuer,
        "client_id": client_id,
        "auth_url": auth_url,
        "jwks_url": jwks_url,
        "token_url": token_url,
        "audience": audience,
        "address": address,
        "zone": zone,
        "deployments": deployment,
        "is_development": development or None,
    }
    given |= {key: value for key, value in options.items() if value is not None}
    if own := load_settings().public_url:
        given.setdefault("address", own)
    try:
        new = NewRegistration.model_validate(given)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        give_up(say("{place}: {message}", place=place, message=field_error(first)))
    secret, now = _secret(), datetime.now(UTC)

    def added(connection: Connection) -> Registration:
        ensure_key(connection, secret, now)
        return registrations.add_registration(connection, new, now)

    _show(_done(added, create=True), new.deployments)


@lti_commands.command("list")
def list_registrations() -> None:
    """List the registered platforms."""
    found = _done(registrations.all_registrations)
    deployments = _done(
        lambda it: {each.id: registrations.deployments_of(it, each.id) for each in found}
    )
    for each in found:
        launched = say("never launched")
        if each.launched_at:
            launched = say("launched {day}", day=f"{each.launched_at:%Y-%m-%d}")
        if not each.any_deployment and not deployments.get(each.id):
            launched = say("waits for `dh-grader lti allow`")
        told = (each.id, visible(each.name), visible(each.issuer), each.client_id, spoken(launched))
        stdout().print("  ".join(told), soft_wrap=True)


@lti_commands.command("show")
def show(registration: RegistrationId) -> None:
    """Show a registration, and the values to paste at the platform."""
    found = _done(lambda it: registrations.registration(it, registration))
    _show(found, _done(lambda it: registrations.deployments_of(it, registration)))


@lti_commands.command("remove")
def remove(registration: RegistrationId) -> None:
    """Remove a registration. Its courses and their attempts stay, and launch no more."""
    _done(lambda it: registrations.remove_registration(it, registration))
    tell(say("Removed. Pages that are open work until their tokens end, at most twelve hours."))


@lti_commands.command("check")
def check(registration: RegistrationId) -> None:
    """Test one registration: keys, clocks, last launch. The exit code is 1 if a test fails."""
    found = _done(lambda it: registrations.registration(it, registration))
    secret, now, is_wrong = _secret(), datetime.now(UTC), False
    key = _done(lambda it: signing_key(it, secret, now))
    for line in check_registration(found, key):
        is_wrong |= line.is_fine is False
        tell_verdict(line.is_fine, line.text)
    raise SystemExit(1 if is_wrong else 0)


@lti_commands.command("roster")
def roster(
    course: Annotated[
        str,
        typer.Argument(help="The id of a course: lti-1234abcd5678.", callback=encodable),
    ],
    names: Annotated[
        bool | None,
        typer.Option("--names/--no-names", help="Whether to store and show names. \\[as before]"),
    ] = None,
) -> None:
    """Bring the learners of a course up to date with the roster of its platform."""
    secret, now = _secret(), datetime.now(UTC)
    asked = _done(lambda it: ask_for_roster(it, course, secret, now))
    try:
        members = read_roster(asked)
    except RosterError as error:
        give_up(error)
    change = _done(lambda it: enrol_members(it, asked, members, secret, shows_names=names))
    tell(
        say(
            "{learners} learners: {added} new, {removed} removed, {renamed} renamed.",
            learners=change.learners,
            added=change.added,
            removed=change.removed,
            renamed=change.renamed,
        )
    )


@_keys.command("rotate")
def rotate_keys() -> None:
    """Add a new key. It is published for a day before it signs; the oldest key is removed."""
    secret, now = _secret(), datetime.now(UTC)
    signs_from = _done(lambda it: rotate(it, secret, now), create=True)
    tell(say("The new key signs from {time} UTC on.", time=f"{signs_from:%Y-%m-%d %H:%M}"))


@_keys.command("list")
def list_keys() -> None:
    """List the published keys, the oldest first, and when they begin to sign."""
    for each in _done(own_key_list):
        tell(
            say(
                "{key}  signs from {time} UTC on",
                key=each.id,
                time=f"{each.signs_from:%Y-%m-%d %H:%M}",
            )
        )


def _secret() -> Secret:
    secret = load_settings().known_secret()
    if secret is None:
        give_up(say("LTI needs a secret: set DH_GRADER_SECRET, or DH_GRADER_SECRET_FILE."))
    return secret


def _done(work: Callable[[Connection], R], *, create: bool = False) -> R:
    with database(create=create) as engine:
        try:
            return in_transaction(engine, work)
        except (RegistrationError, RosterError, LtiError) as error:
            give_up(error)


def _values_in(file: Path) -> dict[str, Any]:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        give_up(say("{file} cannot be read: {reason}", file=str(file), reason=str(error)))
    if not isinstance(found, dict):
        give_up(say("{file}: must be a JSON object.", file=str(file)))
    return found


def _show(found: Registration, deployments: list[str]) -> None:
    lines = {
        say("Registration:"): found.id,
        say("Platform:"): visible(found.name),
        say("Issuer:"): visible(found.issuer),
        say("Client id:"): visible(found.client_id),
        say("Deployments:"): spoken(say("all"))
        if found.any_deployment
        else ", ".join(map(visible, deployments)),
        say("Login (OIDC) address:"): found.login_url,
        say("Redirect address:"): found.launch_url,
        say("Target link address:"): found.launch_url,
        say("Public keys (JWKS):"): found.keys_url,
    }
    width = max(cell_len(spoken(name)) for name in lines) + 1
    for name, value in lines.items():
        stdout().print(set_cell_size(spoken(name), width) + value, soft_wrap=True)
