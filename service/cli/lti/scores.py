"""`dh-grader lti scores`: the scores of a course at its platform."""

from datetime import UTC, datetime
from typing import Annotated

import typer

from service.cli.commands.course_assignments import CourseOption
from service.cli.language import spoken, user_language
from service.cli.operations.course_changes import changed
from service.cli.terminal import stdout, tell
from service.contract.scores import SendAgainRequest
from service.formats.shared.plain_text import number, visible
from service.lti.scores.overview import scores_of, send_again
from service.translations import say


def scores(
    course: CourseOption,
    failed: Annotated[
        bool, typer.Option("--failed", help="Only scores that were refused, or tried in vain.")
    ] = False,
    again: Annotated[bool, typer.Option("--again", help="Send them again.")] = False,
) -> None:
    """List the scores of a course that go to its platform, or send them again."""
    wanted, now = SendAgainRequest(failed=failed), datetime.now(UTC)
    if again:
        queued = changed(lambda it: send_again(it, course, wanted, now))
        tell(say("Scores that are sent again: {queued}.", queued=queued))
        return
    for each in changed(lambda it: scores_of(it, course, wanted, user_language())):
        points = "-" if each.sent_points is None else number(each.sent_points)
        at = f"{each.sent_at:%Y-%m-%d %H:%M} UTC" if each.sent_at else spoken(say("never sent"))
        line = [each.assignment, each.learner, f"{points} / {number(each.max_points)}", at]
        line += [each.state] + ([each.problem] if each.problem else [])
        stdout().print("  ".join(map(visible, line)), soft_wrap=True)
