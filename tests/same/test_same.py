"""Two equal checkouts answer the same, and one small change is seen."""

import shutil
from pathlib import Path

import pytest

from tests.same.asked import Asked, all_asked, share_of
from tests.same.comparing import Difference, differing, told, unpack

ROOT = Path(__file__).parents[2]
pytestmark = [pytest.mark.long, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("base") / "checkout"
    unpack(ROOT, "HEAD", folder)
    return folder


def differences(base: Path, here: Path, asked: list[Asked], scratch: Path) -> list[Difference]:
    scratch.mkdir(exist_ok=True)
    return differing(base, here, asked, scratch)


def test_a_commit_answers_like_itself(base: Path, tmp_path: Path) -> None:
    found = differences(base, base, [*share_of(all_asked(), 500)], tmp_path)
    assert not found, told(found[0])


@pytest.mark.parametrize(
    ("file", "before", "after"),
    [
        pytest.param(
            "service/dh_grader/pasting/around.py",
            "around the table or matrix were",
            "around it were",
            id="a sentence",
        ),
        pytest.param(
            "service/dh_grader/grading/marks.py", "QUARTER: Final = 0.25",
            "QUARTER: Final = 0.26", id="a point",
        ),
        pytest.param(
            "service/dh_grader/grading/diagnosis/table_cells.py",
            "CELL_WORK = 1.2",
            "CELL_WORK = 1.3",
            id="a charge of the work budget",
        ),
    ],
)  # fmt: skip
def test_a_small_change_is_seen(
    file: str, before: str, after: str, base: Path, tmp_path: Path
) -> None:
    changed = tmp_path / "changed"
    shutil.copytree(base, changed)
    text = (changed / file).read_text(encoding="utf-8")
    assert before in text
    (changed / file).write_text(text.replace(before, after), encoding="utf-8")
    reports = [each for each in all_asked() if each.name.startswith("report ")]
    asked = [*share_of((each for each in reports if each.name.endswith("full, en")), 10)]
    assert differences(base, changed, asked, tmp_path / "scratch")
