"""What every bundle holds: the program, its pinned dependencies, the assignment, its exercises."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from service.bundles.archive import BundledFile
from service.bundles.own_wheel import locked_requirements, own_wheel
from service.submissions.assignment import Assignment

_TEMPLATES = Path(__file__).parent / "templates"


class BundleError(Exception):
    """An assignment that cannot be bundled; the text says why."""


@dataclass(frozen=True, slots=True)
class BundleContent:
    """An assignment with the files that grading it needs anywhere.

    ``image`` names the container image of the grader, where a platform wants one.
    """

    assignment: Assignment
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
    found = [BundledFile("assignment.toml", _assignment_text(assignment, file))]
    for each in assignment.exercises:
        if each.path is None:
            source = catalogue[each.exercise.id]
            found.append(BundledFile(f"exercises/{source.name}", source.read_bytes()))
        else:
            found.append(BundledFile(_below(each.path, file), each.path.read_bytes()))
    return BundleContent(assignment, tuple(found), image)


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
