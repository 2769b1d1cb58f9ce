"""The bundle for PrairieLearn's external grader: an image, and a question that it grades.

Source: https://prairielearn.readthedocs.io/en/latest/externalGrading/.
"""

import json
import uuid
from collections.abc import Iterator
from html import escape
from typing import Final

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, template, with_parts
from service.catalogue import Exercise
from service.typeset.statement import statement_html
from service.variants.variant import hidden_variant

ENTRY_POINT: Final = "/usr/local/bin/grade-submission"
# The program starts and grades within two seconds; a container on a busy machine takes longer.
_SECONDS: Final = 60
# The files that pl-file-upload accepts: those that `dh-grader grade` reads.
_PATTERNS: Final = ", ".join(
    f"*.{ending}" for ending in ("json", "toml", "csv", "tsv", "md", "tex", "m", "py", "txt")
)


def files(content: BundleContent) -> list[BundledFile]:
    """Return the files of the bundle for PrairieLearn."""
    dockerfile = template("prairielearn", "Dockerfile")
    script = template("prairielearn", "grade-submission")
    return [
        *(_moved("image", file) for file in content.program()),
        BundledFile("image/Dockerfile", dockerfile),
        BundledFile("image/grade-submission", script, is_executable=True),
        *(_moved("question/tests", file) for file in content.files),
        BundledFile("question/info.json", _info(content)),
        BundledFile("question/question.html", _page(content)),
        *_pages_of_variants(content),
    ]


def _moved(folder: str, file: BundledFile) -> BundledFile:
    return BundledFile(f"{folder}/{file.name}", file.content, file.is_executable)


def _info(content: BundleContent) -> bytes:
    ids = " ".join(exercise.id for exercise in content.exercises)
    info = {
        # A question keeps its uuid when it is bundled again.
        "uuid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"dh-grader {content.title} {ids}")),
        "title": content.title,
        "topic": "Forward kinematics",
        "type": "v3",
        "singleVariant": content.variants is None,
        "gradingMethod": "External",
        "externalGradingOptions": {
            "enabled": True,
            "image": content.image,
            "entrypoint": ENTRY_POINT,
            "timeout": _SECONDS,
        },
    }
    return (json.dumps(info, indent=2, ensure_ascii=False) + "\n").encode()


def _page(content: BundleContent) -> bytes:
    exercises = "".join(_places(content))
    return (
        f"<pl-question-panel>\n{exercises}"
        f'  <pl-file-upload optional-file-patterns="{_PATTERNS}"></pl-file-upload>\n'
        "</pl-question-panel>\n"
        "<pl-submission-panel>\n"
        "  <pl-external-grader-results></pl-external-grader-results>\n"
        "  <pl-file-preview></pl-file-preview>\n"
        "</pl-submission-panel>\n"
    ).encode()


def _places(content: BundleContent) -> Iterator[str]:
    variants = {} if content.variants is None else content.variants.deployed
    places = {name: f"  {{{{{{params.page_{i}}}}}}}\n" for i, name in enumerate(variants, 1)}
    for exercise in content.exercises:
        yield places.get(exercise.id) or "".join(_exercise(exercise))


def _pages_of_variants(content: BundleContent) -> Iterator[BundledFile]:
    if content.variants is None:
        return
    pages: dict[str, dict[str, str]] = {}
    for exercise in content.exercises:
        if exercise.id in content.variants.deployed:
            kept = {part.id for part in exercise.parts}
            pages[exercise.id] = {}
            for seed in content.variants.some(exercise.id):
                variant = hidden_variant(exercise, seed)
                shown = with_parts(variant, {part.id for part in variant.parts} - kept)
                pages[exercise.id][seed] = "".join(_exercise(shown))
    yield BundledFile("question/variants.json", (json.dumps(pages, indent=1) + "\n").encode())
    yield BundledFile("question/server.py", template("prairielearn", "server.py"))


def _exercise(exercise: Exercise) -> Iterator[str]:
    yield f"  <h4>{_text(exercise.title)}</h4>\n"
    yield f"  <div>{_typeset(exercise.statement, exercise)}</div>\n"
    yield f"  <p>Hand in <code>{exercise.id}.json</code>, with an answer to each part:</p>\n"
    yield "  <ul>\n"
    for part in exercise.parts:
        title = f"{_text(part.title)} ({part.points:g} points)"
        yield f"    <li><code>{part.id}</code>: {title}. {_typeset(part.prompt, exercise)}</li>\n"
    yield "  </ul>\n"


def _text(text: str) -> str:
    return _braces(escape(text))


def _typeset(text: str, exercise: Exercise) -> str:
    return _braces(statement_html(text, exercise.symbols))


def _braces(html: str) -> str:
    # PrairieLearn replaces text in double braces.
    return html.replace("{", "&#123;").replace("}", "&#125;")
