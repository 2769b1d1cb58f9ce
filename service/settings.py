"""The settings of an installation: environment variables that begin with DH_GRADER."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal
from urllib.parse import urlsplit

from pydantic import Field, SecretStr, ValidationError, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from service.access.keys import SHORTEST_SECRET, Secret
from service.access.open_access import OpenAccess, open_access
from service.catalogue import FeedbackLevel, shipped_folder
from service.submissions.lookup import nearest

PREFIX = "DH_GRADER_"
# Stands for the folder of the exercises that come with the program.
SHIPPED = "shipped"


_SHORT_SECRET = f"is short; it needs {SHORTEST_SECRET} characters, such as openssl rand -hex 32"


class SettingsError(Exception):
    """One or more environment variables cannot be used; the text has a line for each."""


class Settings(BaseSettings):
    """The settings; each is the variable DH_GRADER_ and its name in capitals."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True)

    host: str = Field("127.0.0.1", description="The address that `serve` listens on.")
    port: int = Field(8000, ge=0, le=65535, description="Its port; 0 takes a free one.")
    workers: int = Field(1, ge=1, le=64, description="How many processes `serve` starts.")
    exercises_dir: Annotated[tuple[Path, ...], NoDecode] = Field(
        default_factory=lambda: (shipped_folder(),),
        description="The folder of exercise files, or several with the separator of PATH between "
        "them; the word `shipped` means the exercises that come with the program.",
    )
    reload_exercises: bool = Field(
        False,
        description="Whether a change to an exercise file counts without a restart. A file that is "
        "broken by it keeps its last good version, and the log says what is wrong.",
    )
    database: SecretStr | None = Field(
        None,
        description="Where attempts are recorded: the path of an SQLite file, or the URL of a "
        "PostgreSQL database (postgresql://user:password@host/name). Without it nothing is.",
    )
    secret: SecretStr | None = Field(
        None,
        description="The secret that keys are hashed and tokens signed with: at least "
        f"{SHORTEST_SECRET} characters that nobody can guess, the same for all processes.",
    )
    secret_file: Path | None = Field(
        None, description="The file that holds this secret, instead of the variable."
    )
    open: str | None = Field(
        None,
        description="What needs no key: `until-keys` for grading and recording until there is a "
        "key, `grade` or `grade,record` for these even then, `none`. By default `until-keys`, but "
        "only if the service listens to this machine alone.",
    )
    key_rate: str | None = Field(
        None,
        description="How often each key, or each learner with a token, may ask: 600/minute, or "
        "several with semicolons between them. By default as often as they like.",
    )
    address_rate: str | None = Field(
        None, description="The same for each address of clients without a key."
    )
    rates_store: SecretStr | None = Field(
        None,
        description="The Redis in which several processes count together, "
        "redis://:password@host:6379/0. By default each counts for itself.",
    )
    read_attempts: bool | None = Field(
        None,
        description="Whether recorded attempts and their statistics are shown to whoever can reach "
        "the service; by default to whoever asks from this machine itself, without a proxy.",
    )
    solutions: bool | None = Field(
        None,
        description="Whether model solutions and the tutor's pages are shown, to whoever can reach "
        "the service; by default to whoever asks from this machine itself, without a proxy.",
    )
    editor_dir: Path | None = Field(
        None,
        description="The folder that the editor of the page writes exercise files to, for whoever "
        "asks from this machine itself; by default it writes none.",
    )
    feedback: FeedbackLevel = Field(
        FeedbackLevel.FULL,
        description="The most that a report over HTTP tells: full, hints, verdicts or score. An "
        "exercise may allow less, and a caller may ask for less.",
    )
    cors_origins: Annotated[tuple[str, ...], NoDecode] = Field(
        (),
        description="Web pages that may call from a browser, as origins with commas between them "
        "(https://course.example.edu); * for all, and by default none.",
    )
    server: str | None = Field(
        None, description="The service that `grade` has submissions graded by; none grades here."
    )
    key: SecretStr | None = Field(None, description="The key that `grade` shows this service.")
    metrics: Literal["off", "local", "all"] = Field(
        "off",
        description="Whether the service counts what it does, and to whom GET /metrics tells it "
        "for Prometheus: nobody (off), whoever asks from this machine itself, without a proxy "
        "(local), or whoever can reach the service (all).",
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="Whether a line of the log is text or a JSON object."
    )
    log_level: Literal["critical", "error", "warning", "info", "debug"] = Field(
        "info", description="What is logged."
    )
    log_addresses: bool = Field(
        True, description="Whether the lines on requests name the addresses of clients."
    )

    @field_validator("host")
    @classmethod
    def _is_named(cls, host: str) -> str:
        # An empty one would listen everywhere, which must be asked for by its name.
        if not host or host.split() != [host]:
            raise ValueError("is no address; write 127.0.0.1 for this machine, 0.0.0.0 for all")
        return host

    @field_validator("database", mode="before")
    @classmethod
    def _is_set(cls, value: object) -> object:
        # A file of settings, such as that of Docker Compose, can leave a variable empty only.
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
            raise ValueError("names no folder; write one, or leave the variable out")
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
                    f"{origin!r} is no origin; write scheme and host in small letters, without a "
                    "path, such as https://course.example.edu"
                )
        return origins

    @property
    def open_access(self) -> OpenAccess:
        """What needs no key."""
        return open_access(self.open)

    def known_secret(self) -> Secret | None:
        """The secret, or None where none is set. Raises SettingsError."""
        if self.secret is not None:
            return Secret(self.secret.get_secret_value())
        if self.secret_file is None:
            return None
        try:
            text = self.secret_file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            raise SettingsError(f"{PREFIX}SECRET_FILE: cannot be read: {error}") from error
        if len(text) < SHORTEST_SECRET:
            raise SettingsError(f"{PREFIX}SECRET_FILE: the secret {_SHORT_SECRET}")
        return Secret(text)


def load_settings(**options: Any) -> Settings:
    """The settings of this process; an option that is given counts more than its variable.

    Raises SettingsError.
    """
    if unknown := list(_unknown()):
        raise SettingsError("\n".join(unknown))
    try:
        return Settings(**{name: value for name, value in options.items() if value is not None})
    except ValidationError as error:
        lines = [
            f"{PREFIX}{str(detail['loc'][0]).upper()}: {_reason(detail['msg'])}"
            for detail in error.errors(include_url=False)
        ]
        raise SettingsError("\n".join(lines)) from error


def _reason(message: str) -> str:
    return message.removeprefix("Value error, ")


def _unknown() -> Iterator[str]:
    """The complaints about variables that are named like settings and are none."""
    for variable in sorted(os.environ):
        prefix, name = variable[: len(PREFIX)].upper(), variable[len(PREFIX) :].lower()
        if prefix == PREFIX and name not in Settings.model_fields:
            meant = nearest(name, Settings.model_fields)
            advice = f"; did you mean {PREFIX}{meant.upper()}?" if meant else ""
            yield f"{variable}: there is no such setting{advice}"


def _origin_in(text: str) -> str:
    """The origin that a browser would send for an address."""
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
