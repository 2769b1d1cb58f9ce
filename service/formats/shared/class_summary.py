"""A summary of a class in a few lines: how many passed, and the most frequent mistakes."""

from collections.abc import Iterator, Sequence
from typing import Final

from rich.cells import cell_len, set_cell_size
from rich.text import Text

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.messages import NOT_PASSED, PASSED
from service.formats.shared.plain_text import percent, points, shortened, visible, whole_percent
from service.statistics import ClassStatistics, CountedSlip
from service.translations import say, told
from service.translations.sentence import Translation

_SLIPS: Final = 10
_UNREAD: Final = 5
_LONGEST: Final = 300
_NOT_GRADED: Final = say("not graded")
_PASSED: Final = say("passed")
_NOT_PASSED: Final = say("not passed")


def result_line(submission: GradedSubmission, translation: Translation | None) -> Text:
    """Return a line about one submission."""
    name = visible(submission.name)
    words = [told(each, translation) for each in (_NOT_GRADED, _PASSED, _NOT_PASSED)]
    width = max(map(cell_len, words))
    not_graded, passed, not_passed = (set_cell_size(each, width) for each in words)
    if not submission.is_complete:
        # The name is at the end, because it may be long.
        return Text.assemble((not_graded, "magenta"), " " * 23, name)
    verdict = (passed, "green") if submission.passed else (not_passed, "red")
    earned = points(submission.points, submission.max_points)
    return Text.assemble(verdict, f"  {earned:>13}  {percent(submission.score):>7}   ", name)


def pass_line(submission: GradedSubmission, translation: Translation | None) -> Text:
    """Return a line that says whether the submission reaches the pass mark."""
    passed = submission.passed
    style, verdict = ("bold green", PASSED) if passed else ("bold red", NOT_PASSED)
    mark = percent(submission.pass_mark)
    shown = told(
        say("{verdict}: the pass mark is {share}.", verdict=verdict, share=mark), translation
    )
    line = Text(shown)
    line.highlight_words([told(verdict, translation)], style)
    return line


class ClassSummary:
    """Counts submissions one by one, and summarizes them in a few lines."""

    def __init__(self, translation: Translation | None = None) -> None:
        self._translation = translation
        self._statistics = ClassStatistics()
        self._count = 0
        self._pass_mark = 0.0

    def add(self, submission: GradedSubmission) -> None:
        """Count a submission."""
        self._count += 1
        self._pass_mark = submission.pass_mark
        if submission.is_complete:
            self._statistics.scores.add(submission.score, passed=submission.passed)
        for file in submission.files:
            if file.report:
                self._statistics.add(self._count, file.report)

    def lines(self) -> Iterator[Text]:
        """Yield the lines of the summary."""
        scores, slips = self._statistics.scores, self._statistics.slips
        graded = say(
            "{passed} of {graded} graded passed (pass mark {share})",
            passed=f"{scores.passed:,}",
            graded=f"{scores.count:,}",
            share=percent(self._pass_mark),
        )
        if scores.count < self._count:
            others = f"{self._count - scores.count:,}"
            graded = say("{graded}, {others} not graded", graded=graded, others=others)
        submissions = say("{submissions} submissions: ", submissions=f"{self._count:,}")
        yield Text.assemble((self._told(submissions), "bold"), self._told(graded))
        if scores.count:
            mean, median = whole_percent(scores.mean), whole_percent(scores.median)
            line = say("Mean score {mean}, median {median}", mean=mean, median=median)
            yield Text(self._told(line))
        yield from self._listed(say("Commonest slips"), slips.counted()[:_SLIPS])
        yield from self._listed(
            say("What could not be read most often"), slips.counted(unreadable=True)[:_UNREAD]
        )

    def _told(self, text: str) -> str:
        return told(text, self._translation)

    def _listed(self, heading: str, slips: Sequence[CountedSlip]) -> Iterator[Text]:
        if slips:
            yield Text()
            yield Text(self._told(heading), "bold")
        for slip in slips:
            parts = ", ".join(dict.fromkeys(part for _, part in slip.parts))
            place = say("({name} in {parts})", name=slip.slip_code, parts=visible(parts))
            sentence = shortened(visible(slip.sentence), _LONGEST)
            yield Text.assemble(f"{slip.count:>4,}  {sentence} ", (self._told(place), "dim"))
