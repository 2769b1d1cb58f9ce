"""What every bundle holds: the program, its pinned dependencies, the assignment, its exercises."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from service.bundles.archive import BundledFile
from service.bundles.own_wheel import locked_requirements, own_wheel
from service.catalogue import Exercise, load_exercise
from service.submissions.assignment import Assignment

_TEMPLATES = Path(__file__).parent / "templates"


class BundleError(Exception):
    """An assignment that cannot be bundled; the text says why."""


@dataclass(frozen=True, slots=True)
class BundleContent:
    """An assignment with the files that grading it needs anywhere.

    ``exercises`` are those that are set, with the parts that are set only. ``image`` names the
    container image of the grader, where a platform wants one.
    """

    title: str
    exercises: tuple[Exercise, ...]
    files: tuple[BundledFile, ...]
    image: str = ""

    def program(self) -> Iterator[BundledFile]:
        """The program as a wheel, and its dependencies."""
        yield own_wheel()
        yield locked_requirements()


def content_of(
    assignment: Assignment, file: Path | None, catalogue: dict[str, Path], image: str = ""
) -> BundleContent:
    """The content for an assignment, of this file or without one. Raises BundleError.

    ``catalogue`` has the exercise files of this installation by id: those that are set are bundled,
    so that the platform grades by the version that is here.
    """
    files = [BundledFile("assignment.toml", _assignment_text(assignment, file))]
    exercises = []
    for each in assignment.exercises:
        source = each.path or catalogue[each.exercise.id]
        name = _below(each.path, file) if each.path else f"exercises/{source.name}"
        files.append(BundledFile(name, source.read_bytes()))
        whole = load_exercise(source)
        parts = tuple(part for part in whole.parts if part.id not in each.left_out)
        exercises.append(replace(whole, parts=parts))
    return BundleContent(assignment.title, tuple(exercises), tuple(files), image)


def setup_script() -> BundledFile:
    """The script that installs the program beside itself."""
    return BundledFile("setup.sh", (_TEMPLATES / "setup.sh").read_bytes(), is_executable=True)


def template(platform: str, name: str) -> bytes:
    """A file of a platform, as it is bundled."""
    return (_TEMPLATES / platform / name).read_bytes()


def _assignment_text(assignment: Assignment, file: Path | None) -> bytes:
    if file is not None:
        return file.read_bytes()
    [only] = assignment.exercises
    # An id is made of letters, digits, - and _, so it needs no escaping.
    name = only.exercise.id
    return f'title = "{name}"\n\n[[exercises]]\nid = "{name}"\n'.encode()


def _below(path: Path, file: Path | None) -> str:
    """The place of an exercise file beside the assignment's. Raises BundleError."""
    folder = (file.parent if file else Path()).resolve()
    try:
        name = path.resolve().relative_to(folder).as_posix()
    except ValueError:
        raise BundleError(
            f"{path} lies outside the folder of the assignment; put it beside the assignment file"
        ) from None
    if name in ("assignment.toml", "requirements.lock"):
        raise BundleError(f"{path} has the name of another file of the bundle; give it another")
    return name
