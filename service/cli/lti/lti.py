"""`dh-grader lti`: the registered platforms, and our keys for signing messages to them."""

import json
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, TypeVar

import typer
from pydantic import ValidationError
from rich.cells import cell_len, set_cell_size
from sqlalchemy import Connection

from service.access.keys import Secret
from service.attempts.storage.database import in_transaction
from service.cli.commands.attempts import database, encodable
from service.cli.language import spoken
from service.cli.lti import joining
from service.cli.lti.scores import scores
from service.cli.terminal import give_up, stdout, tell, tell_verdict
from service.formats.shared.plain_text import visible
from service.lti import registrations
from service.lti.checking import check_registration
from service.lti.own_keys import ensure_key, own_key_list, rotate, signing_key
from service.lti.problems import LtiError
from service.lti.registrations import NewRegistration, Registration, RegistrationError
from service.lti.roster.enrolment import (
    RosterError,
    ask_for_roster,
    enrol_members,
    read_roster,
)
from service.settings import load_settings
from service.submissions.field_errors import field_error
from service.translations import say

R = TypeVar("R")

commands = typer.Typer(
    help="LTI 1.3: platforms that launch courses, and the keys for them.",
    no_args_is_help=True,
    add_completion=False,
)
_keys = typer.Typer(help="The keys with which this service signs.", no_args_is_help=True)
commands.add_typer(_keys, name="keys")
commands.command("invite")(joining.invite_platform)
commands.command("allow")(joining.allow_platform)
commands.command("canvas")(joining.canvas)
commands.command("scores")(scores)

RegistrationId = Annotated[
    str, typer.Argument(help="The id of a registration, as list shows it.", callback=encodable)
]
Value = Annotated[str | None, typer.Option(callback=encodable, help="As the platform shows it.")]


@commands.command("register")
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
    address: Annotated[
        str | None,
        typer.Option(help="This service: https://grader.example.edu \\[DH_GRADER_PUBLIC_URL]"),
    ] = None,
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


@commands.command("list")
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


@commands.command("show")
def show(registration: RegistrationId) -> None:
    """Show a registration, and the values to paste at the platform."""
    found = _done(lambda it: registrations.registration(it, registration))
    _show(found, _done(lambda it: registrations.deployments_of(it, registration)))


@commands.command("remove")
def remove(registration: RegistrationId) -> None:
    """Remove a registration. Its courses and their attempts stay, and launch no more."""
    _done(lambda it: registrations.remove_registration(it, registration))
    tell(say("Removed. Pages that are open work until their tokens end, at most twelve hours."))


@commands.command("check")
def check(registration: RegistrationId) -> None:
    """Test one registration: keys, clocks, last launch. The exit code is 1 if a test fails."""
    found = _done(lambda it: registrations.registration(it, registration))
    secret, now, is_wrong = _secret(), datetime.now(UTC), False
    key = _done(lambda it: signing_key(it, secret, now))
    for line in check_registration(found, key):
        is_wrong |= line.is_fine is False
        tell_verdict(line.is_fine, line.text)
    raise SystemExit(1 if is_wrong else 0)


@commands.command("roster")
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
        give_up(say("{file}: cannot be read: {reason}", file=str(file), reason=str(error)))
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
