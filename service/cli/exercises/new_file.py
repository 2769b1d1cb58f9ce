"""Write a new exercise file, and never over another one."""

from pathlib import Path

from service.cli.terminal import give_up


def write_new(folder: Path, exercise_id: str, text: str) -> Path:
    """Write the file of a new exercise and return its path. Give up if it exists already."""
    file = folder / f"{exercise_id}.toml"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        give_up(f"{file} already exists and was not changed; choose another id or folder")
    except OSError as error:
        give_up(f"{file}: cannot be written: {error.strerror}")
    return file
