"""Every pasted text gets a report."""

import json
from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.grading.reading import preview_pasted
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.robots import EXACT, RRRP
from tests.grading.support.submitting import as_data
from tests.pasting.writers import FORMATS

HEADERS = ["a [mm]", "alpha (deg)", "d", "theta"]
SEEDS = [write([HEADERS, *EXACT.rows(RRRP)]) for write in FORMATS.values()]
FRAGMENTS = [
    "[", "]", "(", ")", "<td>", "&", "\\\\", "|", '"', "'", ";", ",", "\n", "\t", " ", "=", "$",
    "\ud800", "\u202e", "100", "l1", "a", "theta", "1/0", "1e400", "(mm)", "[deg]", "e", "i",
]  # fmt: skip


@st.composite
def pastes(draw: st.DrawFn) -> str:
    text = draw(st.sampled_from(SEEDS))
    for _ in range(draw(st.integers(0, 5))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 10)))
        text = text[:start] + draw(st.sampled_from(FRAGMENTS)) + text[end:]
    return text


@pytest.mark.long
@given(text=pastes() | st.text(max_size=80), level=st.sampled_from(list(FeedbackLevel)))
def test_any_paste_gets_a_report(
    catalogue: Mapping[str, Exercise], text: str, level: FeedbackLevel
) -> None:
    exercise = catalogue[RRRP.exercise]
    submission = Submission({"table": text, "pose": text}, feedback=level)
    report = grade(exercise, submission)
    assert report == grade(exercise, submission)
    assert 0 <= report.points <= report.max_points
    json.dumps(as_data(report), allow_nan=False)
    messages = [
        message
        for part in report.parts
        for found in (part.feedback, *(c.feedback for row in part.rows for c in row.cells))
        for message in found
        if message.span is not None
    ]
    assert all(0 <= m.span[0] <= m.span[1] <= len(text) for m in messages if m.span)


@pytest.mark.long
@given(text=pastes() | st.text(max_size=80), part=st.sampled_from(["table", "pose"]))
def test_any_paste_has_a_preview(catalogue: Mapping[str, Exercise], text: str, part: str) -> None:
    shown = preview_pasted(text, catalogue[RRRP.exercise], part)
    assert bool(shown.problem) != bool(shown.rows)
    for row in shown.rows:
        for cell in row:
            assert 0 <= cell.span[0] <= cell.span[1] <= len(text)
            assert not (cell.problem and cell.text)
