"""The settings of an installation, from environment variables DH_GRADER_….

It knows the names, defaults and forms of all settings. What they do is decided where they are read:
most in ``server/__init__.py``, those of `grade` in ``cli``.
"""

import os
import re
from collections.abc import Callable, Iterator
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Any, Final, Literal
from urllib.parse import urlsplit

from pydantic import Field, SecretStr, ValidationError, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from dh_grader.access import SHORTEST_SECRET, OpenAccess, Secret, open_access
from dh_grader.catalogue import FeedbackLevel, shipped_folder
from dh_grader.regex import regex
from dh_grader.submissions.bodies import field_error, nearest
from dh_grader.translations import LANGUAGES, Sentence, joined, language_named, say

PREFIX = "DH_GRADER_"
# The word in DH_GRADER_EXERCISES_DIR for the folder of the shipped exercises.
SHIPPED = "shipped"
# A scheme, a host with an optional port, and an optional path whose parts are not empty.
_PUBLIC_URL: Final = regex(
    r"https?://(?:[a-z0-9._-]+|\[[0-9a-f:.]+\])(?::[0-9]+)?(?:/[a-z0-9._~%-]+)*/?",
    re.ASCII | re.IGNORECASE,
)
_SERVER: Final = regex(r"https?://[^\s/?#@]+(?:/[^\s?#]*)?", re.IGNORECASE)
_SHORT_SECRET = say(
    "the secret is short; it needs {count} characters, such as openssl rand -hex 32",
    count=SHORTEST_SECRET,
)


class SettingsError(Exception):
    """Environment variables cannot be used; the message has a line for each variable."""


class Settings(BaseSettings):
    """The settings. The environment variable DH_GRADER_HOST sets ``host``, and so on."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True)

    host: str = Field(
        "127.0.0.1",
        description="The address that `serve` listens on: `127.0.0.1` for this machine only, "
        "`0.0.0.0` for all addresses.",
    )
    port: int = Field(
        8000, ge=0, le=65535, description="The port that `serve` listens on; 0 for a free one."
    )
    workers: int = Field(
        1, ge=1, le=64, description="The number of processes that `serve` starts, up to 64."
    )
    public_url: str | None = Field(
        None,
        description="The address under which students reach the service, such as "
        "`https://grader.example.edu`, with the path if a proxy serves it under one. Personal "
        "links begin with it, and the commands that need the address of the service use it. By "
        "default, personal links begin with the address in the tutor's browser (the header "
        "`Host`).",
    )
    exercises_dir: Annotated[tuple[Path, ...], NoDecode] = Field(
        default_factory=lambda: (shipped_folder(),),
        description="The folder of exercise files. Separate several folders as in `PATH`: by `:`, "
        "or by `;` on Windows. The word `shipped` means the exercises that come with the program.",
    )
    reload_exercises: bool = Field(
        False,
        description="`true`: load a changed exercise file without a restart. If the new file "
        "cannot be used, the last good version stays, and the log says what is wrong.",
    )
    database: SecretStr | None = Field(
        None,
        description="The database that records attempts and keys: the path of an SQLite file, or "
        "the URL of a PostgreSQL database (`postgresql://user:password@host/name`). By default "
        "nothing is recorded.",
    )
    secret: SecretStr | None = Field(
        None,
        description="The secret that hashes keys and signs tokens: at least "
        f"{SHORTEST_SECRET} characters that nobody can guess, the same for all processes. By "
        "default there are no keys.",
    )
    secret_file: Path | None = Field(
        None, description="The file that contains the secret, instead of `DH_GRADER_SECRET`."
    )
    open: str | None = Field(
        None,
        description="The operations that work without a key: `until-keys` (grading and recording, "
        "until the first key is created), `grade`, `grade,record` or `none`. By default "
        "`until-keys`, but only as long as the service listens on this machine alone.",
    )
    key_rate: str | None = Field(
        None,
        description="How many requests one key, or one learner with a token, may send, such as "
        "`600/minute`. Separate several limits by semicolons. By default there is no limit.",
    )
    address_rate: str | None = Field(
        None,
        description="How many requests one address may send without a valid key, in the same form. "
        "By default there is no limit.",
    )
    rates_store: SecretStr | None = Field(
        None,
        description="The Redis in which several processes count requests together: "
        "`redis://:password@host:6379/0`. By default each process counts for itself.",
    )
    keep_months: int | None = Field(
        None,
        ge=1,
        le=1200,
        description="For how many months attempts are kept. Older ones are deleted when the "
        "service starts, and by `dh-grader attempts expire`. By default they are kept for ever.",
    )
    read_attempts: bool | None = Field(
        None,
        description="Who may read recorded attempts and statistics. By default: tutors with a "
        "key, or, as long as there are no keys, users on the machine itself (not through a "
        "proxy). `false`: nobody. `true`: as long as there are no keys, everybody who can reach "
        "the service.",
    )
    solutions: bool | None = Field(
        None,
        description="Who may see model solutions and the tutor's pages; the values mean the same "
        "as for `DH_GRADER_READ_ATTEMPTS`.",
    )
    editor_dir: Path | None = Field(
        None,
        description="The folder to which the editor of the tutor's pages saves exercise files, "
        "for users on the machine itself. By default the editor saves nothing.",
    )
    feedback: FeedbackLevel = Field(
        FeedbackLevel.FULL,
        description="The most that a report over HTTP says: `full`, `hints`, `verdicts` or "
        "`score`. An exercise may allow less, and a request may ask for less.",
    )
    cors_origins: Annotated[tuple[str, ...], NoDecode] = Field(
        (),
        description="The origins whose web pages may call the service from a browser, separated "
        "by commas (`https://course.example.edu`); `*` for all. By default none.",
    )
    server: str | None = Field(
        None,
        description="The service to which `dh-grader grade` sends submissions. By default `grade` "
        "grades them itself.",
    )
    key: SecretStr | None = Field(
        None, description="The key that `dh-grader grade` sends to this service."
    )
    language: str = Field(
        "en",
        description="The language of the reports of `dh-grader grade`: `en`, `de`, `es`, `fr` or "
        "`zh`. Over HTTP, the reader chooses the language.",
    )
    metrics: Literal["off", "local", "all"] = Field(
        "off",
        description="Who may read `GET /metrics` (for Prometheus): nobody (`off`; then nothing is "
        "counted), users on the machine itself, not through a proxy (`local`), or everybody who "
        "can reach the service (`all`).",
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="The form of a line of the log: `text`, or a `json` object."
    )
    log_level: Literal["critical", "error", "warning", "info", "debug"] = Field(
        "info",
        description="The least severe messages that are logged: `critical`, `error`, `warning`, "
        "`info` or `debug`.",
    )
    log_addresses: bool = Field(
        True, description="`false`: leave the addresses of clients out of the log."
    )

    @field_validator("host")
    @classmethod
    def _is_named(cls, host: str) -> str:
        # An empty host would listen on all addresses; that requires an explicit 0.0.0.0.
        if not host or host.split() != [host]:
            raise ValueError(
                say(
                    "is not an address; write 127.0.0.1 for this machine, 0.0.0.0 for all addresses"
                )
            )
        return host

    @field_validator("public_url")
    @classmethod
    def _is_public(cls, address: str | None) -> str | None:
        return None if address is None else _checked_public_url(address)

    @field_validator("server")
    @classmethod
    def _is_server(cls, server: str | None) -> str | None:
        # The client checks the address more closely; it is not imported here, because it is large.
        if server is not None and not _SERVER.fullmatch(server):
            raise ValueError(
                say(
                    "{server!r} is not the address of a server; write https://grader.example.edu",
                    server=server,
                )
            )
        return server

    @field_validator("language")
    @classmethod
    def _is_language(cls, tag: str) -> str:
        if language_named(tag) is None:
            raise ValueError(
                say(
                    "{tag!r} is no language of the reports: write one of {known}.",
                    tag=tag,
                    known=", ".join(LANGUAGES),
                )
            )
        return tag

    @field_validator("database", "public_url", mode="before")
    @classmethod
    def _is_set(cls, value: object) -> object:
        # In a file of settings, such as that of Docker Compose, an unset variable is empty.
        return None if isinstance(value, str) and not value.strip() else value

    @field_validator("secret")
    @classmethod
    def _is_long(cls, secret: SecretStr | None) -> SecretStr | None:
        if secret is not None and len(secret.get_secret_value()) < SHORTEST_SECRET:
            raise ValueError(_SHORT_SECRET)
        return secret

    @field_validator("open")
    @classmethod
    def _opens(cls, value: str | None) -> str | None:
        open_access(value)
        return value

    @field_validator("feedback", "metrics", "log_format", "log_level", mode="before")
    @classmethod
    def _lowered(cls, value: object) -> object:
        return value.lower() if isinstance(value, str) else value

    @field_validator("exercises_dir", mode="before")
    @classmethod
    def _folders(cls, value: object) -> object:
        if not isinstance(value, str):
            return value
        names = [name.strip() for name in value.split(os.pathsep) if name.strip()]
        if not names:
            raise ValueError(say("names no folder; write one, or leave the variable out"))
        return tuple(shipped_folder() if name == SHIPPED else Path(name) for name in names)

    @field_validator("cors_origins", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        if isinstance(value, str):
            return tuple(part.strip() for part in value.split(",") if part.strip())
        return value

    @field_validator("cors_origins")
    @classmethod
    def _are_origins(cls, origins: tuple[str, ...]) -> tuple[str, ...]:
        for origin in origins:
            if origin != "*" and origin != _origin_in(origin):
                raise ValueError(
                    say(
                        "{origin!r} is not an origin; write scheme and host in lower case, without "
                        "a path, such as https://course.example.edu",
                        origin=origin,
                    )
                )
        return origins

    @property
    def open_access(self) -> OpenAccess:
        """The operations that need no API key."""
        return open_access(self.open)

    def known_secret(self) -> Secret | None:
        """Return the secret of the installation, or None. Raises SettingsError."""
        # The file is checked even if the other variable overrides it.
        in_file = None if self.secret_file is None else self._secret_in(self.secret_file)
        return in_file if self.secret is None else Secret(self.secret.get_secret_value())

    def _secret_in(self, file: Path) -> Secret:
        try:
            text = file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            unreadable = say("cannot be read: {reason}", reason=str(error))
            raise SettingsError(_of("secret_file", unreadable)) from error
        if len(text) < SHORTEST_SECRET:
            raise SettingsError(_of("secret_file", _SHORT_SECRET))
        return Secret(text)


def load_settings(**options: Any) -> Settings:
    """Load the settings; ``options`` of the command line override environment variables.

    Raises SettingsError for an invalid option, and for an invalid variable, even if an option
    overrides the variable.
    """
    if unknown := list(_unknown()):
        raise SettingsError(joined("\n", unknown))
    settings = _validated(_variable)
    given = {name: value for name, value in options.items() if value is not None}
    # Fields with errors can only be those of options now.
    return _validated(_option, **given) if given else settings


def _validated(named: Callable[[str], str], **given: Any) -> Settings:
    try:
        return Settings(**given)
    except ValidationError as error:
        lines = [
            joined(": ", [named(str(detail["loc"][0])), field_error(detail)])
            for detail in error.errors(include_url=False)
        ]
        raise SettingsError(joined("\n", lines)) from error


def _variable(name: str) -> str:
    return f"{PREFIX}{name.upper()}"


def _option(name: str) -> str:
    return f"--{name}"


def _of(name: str, fault: str) -> Sentence:
    return joined(": ", [_variable(name), fault])


def _unknown() -> Iterator[str]:
    for variable in sorted(os.environ):
        prefix, name = variable[: len(PREFIX)].upper(), variable[len(PREFIX) :].lower()
        if prefix == PREFIX and name not in Settings.model_fields:
            meant = nearest(name, Settings.model_fields)
            if meant is None:
                yield say("{variable}: there is no such setting", variable=variable)
            else:
                yield say(
                    "{variable}: there is no such setting; did you mean {meant}?",
                    variable=variable,
                    meant=f"{PREFIX}{meant.upper()}",
                )


def _checked_public_url(address: str) -> str:
    # Return the address without a trailing slash. Raises ValueError.
    try:
        parts = urlsplit(address)
        host = parts.hostname if parts.port != 0 else None
    except ValueError:
        parts, host = urlsplit(""), None
    if not host or not _PUBLIC_URL.fullmatch(address) or {".", ".."} & {*parts.path.split("/")}:
        raise ValueError(
            say(
                "{address!r} is not the address of this service; write "
                "https://grader.example.edu, without a question mark or a name of a user",
                address=address,
            )
        )
    if parts.scheme != "https" and not _is_here(host):
        raise ValueError(
            say("must begin with https://, because the links contain keys of learners")
        )
    return address.rstrip("/")


def _is_here(host: str) -> bool:
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False


def _origin_in(text: str) -> str:
    try:
        parts = urlsplit(text)
        port = f":{parts.port}" if parts.port is not None else ""
    except ValueError:
        return ""
    host = (parts.hostname or "").replace("*", "")
    if not host.isascii():
        return ""
    bracketed = f"[{host}]" if ":" in host else host
    usual = {"http": ":80", "https": ":443"}.get(parts.scheme)
    return f"{parts.scheme}://{bracketed}{'' if port == usual else port}" if host else ""
