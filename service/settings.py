"""The settings of an installation: environment variables that begin with DH_GRADER."""

import os
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import Field, ValidationError, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from service.catalogue import FeedbackLevel, shipped_folder

PREFIX = "DH_GRADER_"
# Stands for the folder of the exercises that come with the program.
SHIPPED = "shipped"


class SettingsError(Exception):
    """One or more environment variables cannot be used; the text has a line for each."""


class Settings(BaseSettings):
    """The settings; each is the variable DH_GRADER_ and its name in capitals."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True)

    host: str = Field("127.0.0.1", description="The address that `serve` listens on.")
    port: int = Field(8000, ge=0, le=65535, description="Its port; 0 takes a free one.")
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
    solutions: bool = Field(
        False,
        description="Whether GET /v1/exercises/{id}/solution shows the model solutions, to whoever "
        "can reach the service.",
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
    log_level: Literal["critical", "error", "warning", "info", "debug"] = Field(
        "info", description="What is logged."
    )

    @field_validator("feedback", "log_level", mode="before")
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
            parts = urlsplit(origin)
            if origin != "*" and origin != f"{parts.scheme}://{parts.netloc}":
                raise ValueError(f"{origin!r} is no origin; write scheme and host, without a path")
        return origins


def load_settings() -> Settings:
    """The settings of this process. Raises SettingsError."""
    try:
        return Settings()
    except ValidationError as error:
        lines = [
            f"{PREFIX}{str(detail['loc'][0]).upper()}: {detail['msg']}"
            for detail in error.errors(include_url=False)
        ]
        raise SettingsError("\n".join(lines)) from error
