"""The lines that the command line prints about an assignment of a course."""

from collections.abc import Callable, Iterator, Mapping
from datetime import datetime

from service.catalogue import Exercise, FeedbackLevel
from service.contract.courses import CourseAssignment, Extension, MissingLearner
from service.courses.times import with_own_dates
from service.formats.shared.plain_text import number, visible
from service.translations import Sentence, joined, say


def assignment_lines(
    assignment: CourseAssignment, installed: Callable[[], Mapping[str, Exercise]]
) -> Iterator[Sentence]:
    """Yield the lines about an assignment. ``installed`` returns all exercises of the service."""
    total = number(sum(each.points for each in assignment.exercises))
    title = visible(assignment.title)
    yield say("{id}: {title}, {points} points", id=assignment.id, title=title, points=total)
    for each in assignment.exercises:
        points = number(each.points)
        yield say("{exercise}, {points} points", exercise=each.exercise, points=points)
    if assignment.opens is not None:
        yield say("opens {time}", time=_time(assignment.opens))
    yield from ends(assignment)
    late = _late(assignment)
    limit = say("attempts not limited")
    if assignment.limit is not None:
        limit = say("attempts at most {limit}", limit=assignment.limit)
    yield joined("; ", [limit, late])
    levels = ", ".join(FeedbackLevel(each).value for each in assignment.feedback or ())
    yield say("feedback {level}", level=levels or say("that of each exercise"))
    yield say(
        "practice {practice}; solution {solution}",
        practice=assignment.practice,
        solution=assignment.solution,
    )
    if assignment.hint_prices is not None:
        prices = ", ".join(f"{each:.0%}" for each in assignment.hint_prices)
        yield say("the steps of a hint cost {prices} of the points", prices=prices)
    if assignment.variants:
        yield say("each learner has variants of their own")
        catalogue = installed()
        names = [each.exercise for each in assignment.exercises]
        same = [name for name in names if name in catalogue and catalogue[name].vary is None]
        if same:
            yield say("but not in {exercises}: no variants there", exercises=", ".join(same))
    yield from _extension_lines(assignment)


def _late(assignment: CourseAssignment) -> Sentence:
    if not assignment.due:
        return say("no due date")
    if assignment.closes or any(each.closes for each in assignment.extensions):
        return say("late attempts earn {share}", share=f"{assignment.late_worth:.0%}")
    return say("no late attempts")


def _extension_lines(assignment: CourseAssignment) -> Iterator[Sentence]:
    for extension in assignment.extensions:
        told = [*ends(with_own_dates(assignment, extension))]
        if extension.limit:
            told.append(say("at most {limit} attempts", limit=extension.limit))
        # Without a due date, an extension of the closing date alone has no effect.
        if told:
            yield joined(": ", [visible(extension.learner), joined("; ", told)])


def ends(dates: CourseAssignment | Extension | MissingLearner) -> Iterator[Sentence]:
    """Yield lines that say when answers are due and when the assignment closes."""
    if dates.due is not None:
        yield say("due {time}", time=_time(dates.due))
    if dates.closes is not None:
        yield say("closes {time}", time=_time(dates.closes))


def _time(moment: datetime) -> str:
    return f"{moment:%Y-%m-%d %H:%M %Z}"
