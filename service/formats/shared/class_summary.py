"""A summary of a class in a few lines: how many passed, and the most frequent mistakes."""

from collections.abc import Iterator, Sequence
from typing import Final

from rich.text import Text

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.plain_text import percent, points, shortened, visible, whole_percent
from service.statistics import ClassStatistics, CountedSlip

_SLIPS: Final = 10
_UNREAD: Final = 5
_LONGEST: Final = 300


def result_line(submission: GradedSubmission) -> Text:
    """Return a line about one submission. The name is at the end, because it may be long."""
    name = visible(submission.name)
    if not submission.is_graded:
        return Text.assemble(("not graded", "magenta"), " " * 23, name)
    verdict = ("passed    ", "green") if submission.passed else ("not passed", "red")
    earned = points(submission.points, submission.max_points)
    return Text.assemble(verdict, f"  {earned:>13}  {percent(submission.score):>7}   ", name)


def pass_line(submission: GradedSubmission) -> Text:
    """Return a line that says whether the submission reaches the pass mark."""
    verdict = ("Passed", "bold green") if submission.passed else ("Not passed", "bold red")
    return Text.assemble(verdict, f": the pass mark is {percent(submission.pass_mark)}.")


class ClassSummary:
    """A summary of submissions that are added one by one; none of them is kept."""

    def __init__(self) -> None:
        self._statistics = ClassStatistics()
        self._count = 0
        self._pass_mark = 0.0

    def add(self, submission: GradedSubmission) -> None:
        """Count a submission."""
        self._count += 1
        self._pass_mark = submission.pass_mark
        if submission.is_graded:
            self._statistics.scores.add(submission.score, passed=submission.passed)
        for file in submission.files:
            if file.report:
                self._statistics.add(self._count, file.report)

    def lines(self) -> Iterator[Text]:
        """Yield the lines of the summary."""
        scores, slips = self._statistics.scores, self._statistics.slips
        yield Text.assemble(
            (f"{self._count:,} submissions: ", "bold"),
            f"{scores.passed:,} of {scores.count:,} graded passed "
            f"(pass mark {percent(self._pass_mark)})",
            f", {self._count - scores.count:,} not graded" if scores.count < self._count else "",
        )
        if scores.count:
            mean, median = whole_percent(scores.mean), whole_percent(scores.median)
            yield Text(f"Mean score {mean}, median {median}")
        yield from _listed("Commonest slips", slips.counted()[:_SLIPS])
        yield from _listed(
            "What could not be read most often", slips.counted(unreadable=True)[:_UNREAD]
        )


def _listed(heading: str, slips: Sequence[CountedSlip]) -> Iterator[Text]:
    """Yield a heading and a line for each slip: its count, its sentence, its code and parts."""
    if slips:
        yield Text()
        yield Text(heading, "bold")
    for slip in slips:
        parts = ", ".join(dict.fromkeys(part for _, part in slip.parts))
        sentence = shortened(visible(slip.sentence), _LONGEST)
        yield Text.assemble(
            f"{slip.count:>4,}  {sentence} ", (f"({slip.slip_code} in {visible(parts)})", "dim")
        )
