"""Files that would take long to parse are refused."""

import pytest
from dh_grader.submissions.documents import UnusableFileError
from dh_grader.submissions.files import MAX_TOML_DOTS, MAX_TOML_SIZE, read_content


@pytest.mark.parametrize(
    "content",
    [
        # A key of 120,000 dots took more memory than the machine had.
        "a" + ".a" * MAX_TOML_DOTS + ".a = 1",
        "\n".join(f"a{i} = 1" for i in range(MAX_TOML_SIZE // 8)),
    ],
    ids=["dots", "keys"],
)
def test_toml_over_a_limit_is_refused(content: str) -> None:
    with pytest.raises(UnusableFileError, match="is more TOML than 64 KiB or 2,000 dots"):
        read_content(content.encode(), "answers.toml")


def test_toml_within_the_limits_is_read() -> None:
    cells = ", ".join(["1.5"] * (MAX_TOML_DOTS - 1))
    content = read_content(f"[answers]\ntable = [{cells}]".encode(), "answers.toml")
    assert content.value == {"answers": {"table": [1.5] * (MAX_TOML_DOTS - 1)}}
