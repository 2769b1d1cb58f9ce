"""Files that would take long to read are refused before they are."""

from pathlib import Path

import pytest

from service.cli.submission_files import (
    MAX_TOML_DOTS,
    MAX_TOML_SIZE,
    UnusableFileError,
    read_submission,
)


@pytest.mark.parametrize(
    "content",
    [
        # A key of 120,000 dots took more memory than the machine had.
        "a" + ".a" * MAX_TOML_DOTS + ".a = 1",
        "\n".join(f"a{i} = 1" for i in range(MAX_TOML_SIZE // 8)),
    ],
    ids=["dots", "keys"],
)
def test_toml_that_takes_long_is_refused(tmp_path: Path, content: str) -> None:
    file = tmp_path / "answers.toml"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(UnusableFileError, match="is more TOML than 64 KiB or 2,000 dots"):
        read_submission(file, None)


def test_toml_within_the_limits_is_read(tmp_path: Path) -> None:
    file = tmp_path / "answers.toml"
    cells = ", ".join(["1.5"] * (MAX_TOML_DOTS - 1))
    file.write_text(f"[answers]\ntable = [{cells}]", encoding="utf-8")
    assert read_submission(file, None).answers == {"table": [1.5] * (MAX_TOML_DOTS - 1)}
