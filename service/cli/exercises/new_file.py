"""Write new exercise files without replacing existing ones."""

from collections.abc import Iterable
from pathlib import Path

from service.catalogue import shipped_folder
from service.cli.terminal import complain, give_up, unwritable
from service.settings import load_settings
from service.translations import say


def write_new(folder: Path, exercise_id: str, text: str) -> Path:
    """Write the file of a new exercise and return its path; exit if the file exists."""
    file = folder / f"{exercise_id}.toml"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        give_up(
            say(
                "{file} already exists and was not changed; choose another id or folder",
                file=str(file),
            )
        )
    except OSError as error:
        give_up(unwritable(file, error))
    return file


def warn_of_unread(exercises: Iterable[str]) -> None:
    """Warn that a running service may not have read these new exercises yet."""
    shipped = shipped_folder()
    own = [each for each in exercises if not (shipped / f"{each}.toml").is_file()]
    if own and not load_settings().reload_exercises:
        complain(
            say(
                "{ids}: if the file is new, restart the service. It reads new files only "
                "when it starts, or at once with DH_GRADER_RELOAD_EXERCISES=true.",
                ids=", ".join(own),
            )
        )
