"""The content of every bundle: the program, its dependencies, the assignment, its exercises."""

from collections.abc import Container, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from service.bundles.archive import BundledFile
from service.bundles.own_wheel import locked_requirements, own_wheel
from service.bundles.variants import BundleVariants, variants_of
from service.catalogue import Exercise, load_exercise
from service.submissions.assignment import Assignment

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
            name = _below(each.path, file)
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


def _below(path: Path, file: Path) -> str:
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
