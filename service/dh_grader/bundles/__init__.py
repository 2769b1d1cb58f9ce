"""Bundles for grading platforms: zip files with the program, an assignment and scripts.

The scripts are in ``templates``. How a platform shows a report is in ``dh_grader.formats``.
"""

import base64
import csv
import hashlib
import io
import json
import stat
import uuid
import zipfile
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from html import escape
from importlib.metadata import Distribution, distribution
from pathlib import Path
from typing import Any, Final

from dh_grader.catalogue import Exercise, load_exercise, shipped_folder
from dh_grader.submissions import Assignment
from dh_grader.translations import compiled_catalogue
from dh_grader.typeset import statement_html
from dh_grader.variants import hidden_variant, seed_of

# --- Pack files into a reproducible zip file


# The earliest time that a zip file can represent.
_NO_TIME = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class BundledFile:
    """A file of a bundle; ``name`` is its path in the bundle, with ``/``."""

    name: str
    content: bytes
    is_executable: bool = False


def zipped(files: Iterable[BundledFile]) -> bytes:
    """Return a zip file of the files; equal files give equal bytes."""
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(files, key=lambda file: file.name):
            entry = zipfile.ZipInfo(file.name, _NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, so that the modes below are used
            entry.external_attr = (stat.S_IFREG | (0o755 if file.is_executable else 0o644)) << 16
            archive.writestr(entry, file.content)
    return written.getvalue()


# --- The variants of a bundle: which seed (and so which numbers) a student gets


# The number of variants on PrairieLearn if no seeds are deployed.
DRAWN: Final = 40


class UnknownStudentError(ValueError):
    """The platform's data do not identify the student; the message says why."""


@dataclass(frozen=True, slots=True)
class BundleVariants:
    """The secret of a bundle, and the allowed seeds (short texts) of each exercise."""

    secret: str = field(repr=False)
    deployed: Mapping[str, Sequence[str]]

    def seeds_of(self, learner: str) -> Mapping[str, str]:
        """Return the seed of a learner's variant of each exercise."""
        return {
            exercise: seed_of(self.secret, learner, exercise, 0, deployed)
            for exercise, deployed in self.deployed.items()
        }

    def some(self, exercise: str) -> Sequence[str]:
        """Return the possible seeds for an exercise: the deployed ones, or random ones."""
        drawn = (seed_of(self.secret, f"variant {i}", exercise, 0) for i in range(DRAWN))
        return self.deployed[exercise] or tuple(drawn)

    def file(self) -> BundledFile:
        """Return the file with the secret and the seeds, for the script on the platform."""
        content = {"secret": self.secret, "deployed": dict(self.deployed)}
        return BundledFile("variants.json", (json.dumps(content, indent=2) + "\n").encode())


def variants_of(exercises: Sequence[Exercise], secret: str) -> BundleVariants:
    """Return the variants for a bundle with these exercises."""
    return BundleVariants(
        secret, {each.id: each.vary.deployed for each in exercises if each.vary is not None}
    )


def platform_seeds(submission: Path, variants: Path | None) -> Mapping[str, str]:
    """Return the seed of a student's variant of each exercise. Raises UnknownStudentError.

    ``submission`` is the file in which a platform describes the submission. ``variants`` is the
    file of the bundle with the secret and the seeds.
    """
    told = _read(submission)
    match told:
        case {"params": {"seeds": dict(seeds)}}:
            return {str(exercise): str(seed) for exercise, seed in seeds.items()}
        case {"users": [_, *_] as users} if variants is not None:
            numbers = [each["id"] for each in users if isinstance(each, dict) and "id" in each]
            if len(numbers) == len(users) and all(type(each) is int for each in numbers):
                own = _read(variants)
                found = BundleVariants(own["secret"], own["deployed"])
                # All members of a group have the variants of one of them.
                return found.seeds_of(str(min(numbers)))
    raise UnknownStudentError(f"{submission} does not say whose submission it is")


def _read(file: Path) -> Any:
    try:
        return json.loads(file.read_bytes())
    except (OSError, ValueError) as error:
        raise UnknownStudentError(f"{file} cannot be read: {error}") from error


# --- Build a wheel of the running program from its installed files
#
# So a bundle contains exactly this version, whether installed from a wheel or a checkout. Source:
# https://packaging.python.org/en/latest/specifications/binary-distribution-format/.


_NAME = "dh-grader"
_WHEEL = "Wheel-Version: 1.0\nGenerator: dh-grader\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
_PACKAGE = Path(__file__).parents[1]


def own_wheel() -> BundledFile:
    """Return a wheel of the running program, with the file name that installers expect."""
    installed = distribution(_NAME)
    stem = f"{_NAME.replace('-', '_')}-{installed.version}"
    files = [*_program(), *_metadata(installed, f"{stem}.dist-info")]
    record = f"{stem}.dist-info/RECORD"
    files.append(BundledFile(record, _record(files, record)))
    return BundledFile(f"{stem}-py3-none-any.whl", zipped(files))


def locked_requirements() -> BundledFile:
    """Return the file of pinned dependencies with hashes."""
    packaged = _PACKAGE / "_requirements.lock"
    lock = packaged if packaged.is_file() else _PACKAGE.parents[1] / "requirements.lock"
    return BundledFile("requirements.lock", lock.read_bytes())


def _program() -> Iterator[BundledFile]:
    yield from _own_wheel_below(_PACKAGE, "dh_grader")
    if not (_PACKAGE / "_exercises").is_dir():
        yield from _own_wheel_below(shipped_folder(), "dh_grader/_exercises")
        yield BundledFile("dh_grader/_requirements.lock", locked_requirements().content)


def _own_wheel_below(folder: Path, name: str) -> Iterator[BundledFile]:
    for file in sorted(folder.rglob("*")):
        if not file.is_file() or "__pycache__" in file.parts:
            continue
        place, content = f"{name}/{file.relative_to(folder).as_posix()}", file.read_bytes()
        # A wheel has the compiled catalogues of translations, a checkout has their texts.
        if file.suffix == ".po":
            yield BundledFile(
                place.removesuffix(".po") + ".mo", compiled_catalogue(content, file.name)
            )
        elif file.suffix != ".mo" or not file.with_suffix(".po").is_file():
            yield BundledFile(place, content)


def _metadata(installed: Distribution, folder: str) -> Iterator[BundledFile]:
    yield BundledFile(f"{folder}/WHEEL", _WHEEL.encode())
    for name in ("METADATA", "entry_points.txt", "licenses/LICENSE", "licenses/NOTICE"):
        text = installed.read_text(name)
        if text is not None:
            yield BundledFile(f"{folder}/{name}", text.encode())


def _record(files: list[BundledFile], record: str) -> bytes:
    written = io.StringIO()
    rows = csv.writer(written, lineterminator="\n")
    for file in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.content).digest()).rstrip(b"=")
        rows.writerow([file.name, f"sha256={digest.decode()}", len(file.content)])
    rows.writerow([record, "", ""])
    return written.getvalue().encode()


# --- The content of every bundle: the program, its dependencies, the assignment, its exercises


_TEMPLATES = Path(__file__).parent / "templates"


class BundleError(Exception):
    """The assignment cannot be bundled; the message says why."""


@dataclass(frozen=True, slots=True)
class BundleContent:
    """An assignment with all files that are needed to grade it."""

    title: str
    # The assigned exercises with only the assigned parts.
    exercises: tuple[Exercise, ...]
    files: tuple[BundledFile, ...]
    # The name of the grader's container image, if the platform uses one.
    image: str = ""
    # None if all students get the same exercises.
    variants: BundleVariants | None = None

    def program(self) -> Iterator[BundledFile]:
        """Yield the program as a wheel, and its pinned dependencies."""
        yield own_wheel()
        yield locked_requirements()


def content_of(
    assignment: Assignment,
    file: Path | None,
    catalogue: dict[str, Path],
    image: str = "",
    secret: str = "",
) -> BundleContent:
    """Return an assignment with all files that are needed to grade it. Raises BundleError.

    ``file`` is the assignment's file, if any. ``catalogue`` has exercise files by id. ``secret``
    determines the variants of students.
    """
    files = [BundledFile("assignment.toml", _assignment_text(assignment, file))]
    exercises = []
    for each in assignment.exercises:
        source = each.path or catalogue[each.exercise.id]
        name = f"exercises/{source.name}"
        if each.path is not None and file is not None:
            name = _content_below(each.path, file)
        files.append(BundledFile(name, source.read_bytes()))
        whole = load_exercise(source)
        exercises.append(with_parts(whole, each.left_out))
    variants = variants_of(exercises, secret) if assignment.variants else None
    return BundleContent(assignment.title, tuple(exercises), tuple(files), image, variants)


def with_parts(exercise: Exercise, left_out: Container[str]) -> Exercise:
    """Return the exercise without the parts whose ids are in ``left_out``."""
    parts = tuple(part for part in exercise.parts if part.id not in left_out)
    return replace(exercise, parts=parts)


def setup_script() -> BundledFile:
    """Return the script that installs the program."""
    return BundledFile("setup.sh", (_TEMPLATES / "setup.sh").read_bytes(), is_executable=True)


def template(platform: str, name: str) -> bytes:
    """Return the content of the template ``name`` for a platform."""
    return (_TEMPLATES / platform / name).read_bytes()


def _assignment_text(assignment: Assignment, file: Path | None) -> bytes:
    if file is not None:
        return file.read_bytes()
    [only] = assignment.exercises
    # An id has only letters, digits, - and _, so it needs no escaping.
    name = only.exercise.id
    return f'title = "{name}"\n\n[[exercises]]\nid = "{name}"\n'.encode()


def _content_below(path: Path, file: Path) -> str:
    folder = file.parent.resolve()
    try:
        name = path.resolve().relative_to(folder).as_posix()
    except ValueError:
        raise BundleError(
            f"{path} is outside the folder of the assignment; put it beside the assignment file"
        ) from None
    if name in ("assignment.toml", "requirements.lock", "variants.json"):
        raise BundleError(f"{path} has the name of another file of the bundle; give it another")
    return name


# --- The bundle for PrairieLearn's external grader: an image, and a question that it grades
#
# Source: https://prairielearn.readthedocs.io/en/latest/externalGrading/.


ENTRY_POINT: Final = "/usr/local/bin/grade-submission"
# The program starts and grades within two seconds; a container on a busy machine takes longer.
_SECONDS: Final = 60
# The files that pl-file-upload accepts: those that `dh-grader grade` reads.
_PATTERNS: Final = ", ".join(
    f"*.{ending}" for ending in ("json", "toml", "csv", "tsv", "md", "tex", "m", "py", "txt")
)


def prairielearn_files(content: BundleContent) -> list[BundledFile]:
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


# --- The bundle for Gradescope: ``setup.sh`` builds the image, ``run_autograder`` grades
#
# Source: https://gradescope-autograders.readthedocs.io/en/latest/specs/, "File hierarchy".


def gradescope_files(content: BundleContent) -> list[BundledFile]:
    """Return the files of the bundle for Gradescope."""
    script = template("gradescope", "run_autograder")
    return [
        *content.program(),
        *content.files,
        *([] if content.variants is None else [content.variants.file()]),
        setup_script(),
        BundledFile("run_autograder", script, is_executable=True),
    ]


# --- The bundle for jobs of continuous integration on any platform; see docs/ci


def ci_files(content: BundleContent) -> list[BundledFile]:
    """Return the files of the bundle for continuous integration. Raises BundleError."""
    if content.variants is not None:
        reason = "a job does not know whose files it grades, so this bundle cannot have variants"
        raise BundleError(f"{reason}; leave out variants in the assignment")
    return [
        *content.program(),
        *content.files,
        setup_script(),
        BundledFile("grade", template("ci", "grade"), is_executable=True),
    ]


# --- Bundles for grading platforms: zip files with the program, an assignment and scripts


__all__ = ["BUNDLES", "BundleContent", "BundleError", "BundledFile", "content_of", "zipped"]

BUNDLES: Final[Mapping[str, Callable[[BundleContent], list[BundledFile]]]] = {
    "gradescope": gradescope_files,
    "prairielearn": prairielearn_files,
    "ci": ci_files,
}
