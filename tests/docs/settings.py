"""Write docs/settings.md, the page of all environment variables.

Run ``python -m tests.docs.settings > docs/settings.md``.
"""

import sys
from enum import StrEnum
from typing import Final

from dh_grader.settings import PREFIX, SHIPPED, Settings
from pydantic.fields import FieldInfo

_INTRODUCTION: Final = f"""\
# Settings

Every setting is an environment variable. An option of the command line (`--port`) overrides its
variable. An invalid value prevents startup, even if an option overrides it. So does an unknown
`{PREFIX}…` variable, for example a typo. The program then ends with exit code 2 and names the
variable.

Behind a proxy on another machine you may need one more variable, `FORWARDED_ALLOW_IPS`
([Behind nginx](deployment.md#behind-nginx)).

This page is generated: `python -m tests.docs.settings`."""

# The sections: a heading, an introduction, and the settings in order.
SECTIONS: Final = (
    (
        "The service",
        "See [Run it for a course](deployment.md).",
        ("host", "port", "workers", "public_url"),
    ),
    (
        "Exercises",
        "See [Write an exercise](write-an-exercise.md).",
        ("exercises_dir", "reload_exercises", "editor_dir"),
    ),
    (
        "What students and tutors see",
        "See [How much is told](messages.md#how-much-is-told).",
        ("feedback", "solutions", "read_attempts", "cors_origins"),
    ),
    (
        "Attempts and keys",
        "See [Recorded attempts](attempts.md) and [Keys](keys.md).",
        (
            "database",
            "keep_months",
            "secret",
            "secret_file",
            "open",
            "key_rate",
            "address_rate",
            "rates_store",
        ),
    ),
    (
        "Log and metrics",
        "See [Operations](operations.md).",
        ("log_format", "log_level", "log_addresses", "metrics"),
    ),
    (
        "The command line",
        "Only `dh-grader grade` reads these. [`grade --server`](client.md) explains the first two.",
        ("server", "key", "language"),
    ),
)


def page() -> str:
    """Return the whole page, in Markdown."""
    sections = [_INTRODUCTION]
    for heading, introduction, names in SECTIONS:
        rows = ["| Variable | Default | Meaning |", "|---|---|---|"]
        rows += [_row(name, Settings.model_fields[name]) for name in names]
        sections += [f"## {heading}", introduction, "\n".join(rows)]
    return "\n\n".join(sections) + "\n"


def _row(name: str, field: FieldInfo) -> str:
    return f"| `{PREFIX}{name.upper()}` | {_default(name, field)} | {field.description} |"


def _default(name: str, field: FieldInfo) -> str:
    if name == "exercises_dir":
        return f"`{SHIPPED}`"
    match field.default:
        case None | ():
            return "not set"
        case bool(value):
            return f"`{str(value).lower()}`"
        case StrEnum(value=value) | value:
            return f"`{value}`"


if __name__ == "__main__":
    sys.stdout.write(page())
