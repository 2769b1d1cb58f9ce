"""The routes for hints, for pictures of DH rules, and for alternatives to a correct table."""

from functools import partial
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.courses.practice import PracticeGate
from service.api.document.openapi import posting, refusals
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404, require_parts
from service.api.http.memoized import MemoizedResults
from service.api.http.problems import ProblemError
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access
from service.api.routes.figures import SvgResponse, figure_headers
from service.api.turns import run_in_turns
from service.catalogue import Exercise, FeedbackLevel, least
from service.catalogue.parts.dh_table import DhTableSpec
from service.contract.grading import (
    ChoicesRequest,
    FrameChoices,
    Hint,
    HintRequest,
    TableRow,
    ValidTable,
)
from service.figures.drawing.style import Theme
from service.grading import Submission, report_on_part
from service.grading.report import RuleName
from service.hints.choices import other_choices
from service.hints.picture import rule_picture
from service.hints.rules import RULES
from service.hints.steps import STEPS, Topic, hint_step, may_have_hints
from service.kinematics.dh import Convention
from service.translations import say

_RULE = Path(max_length=60, description="The name of a rule.", examples=["link_twist"])


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    access: Access,
    practice: PracticeGate,
    own: OwnVariants,
) -> APIRouter:
    """Return the routes for hints; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["grading"])
    pictures = MemoizedResults()

    @router.post(
        "/exercises/{exercise_id}/hints",
        operation_id="getHint",
        summary="Get a hint for a message of a report",
        response_description="One step of the hint.",
        **in_languages(
            of_assignment(
                posting(HintRequest, Hint, None, HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND)
            )
        ),
    )
    async def hint(exercise_id: ExerciseId, request: Request) -> Response:
        """Return a step of the hint for a message on a mistake. Nothing is recorded.

        The body has the answers that got the message, its code and its place, and the step: what
        to look at, the rule with its picture, or the rule on this row. A hint has no value of the
        answer. Messages on unreadable or empty entries have no hints.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check_hints(access.caller(request), exercise)
        body = await read_body(HintRequest, request)
        found = await run_in_turns(request, partial(hint_for, exercise, body, feedback))
        language = language_of(request)
        content = found.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language)

    @router.post(
        "/exercises/{exercise_id}/choices",
        operation_id="getFrameChoices",
        summary="Show other valid choices of frames",
        response_description="Other valid tables.",
        **in_languages(
            of_assignment(
                posting(
                    ChoicesRequest, FrameChoices, None, HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND
                )
            )
        ),
    )
    async def choices(exercise_id: ExerciseId, request: Request) -> Response:
        """Return up to three other tables that are as right as a right table.

        They are made from that table: in each, one frame is turned by a half turn, or its origin
        lies elsewhere on its z axis. For a table that is not right there are none.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check(access.caller(request), exercise.plain_id)
        body = await read_body(ChoicesRequest, request)
        found = await run_in_turns(request, partial(choices_for, exercise, body))
        language = language_of(request)
        return told_json(found.model_dump_json(context=language.translation), language)

    @router.get(
        "/rules/{convention}/{rule}.svg",
        operation_id="getRulePicture",
        summary="Draw the picture of a rule",
        response_class=SvgResponse,
        response_description="The drawing.",
        responses=refusals(HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY),
    )
    async def draw_rule(
        convention: Annotated[Convention, Path(description="The convention.")],
        rule: Annotated[str, _RULE],
        theme: Annotated[Theme, Query(description="The colours, as of a figure.")] = Theme.AUTO,
    ) -> Response:
        """Draw two frames, and the lengths and angles between them that a rule is about."""
        name = next((each for each in RULES if each == rule and RULES[each].pictured), None)
        if name is None:
            raise ProblemError(HTTPStatus.NOT_FOUND, "There is no picture of such a rule.")
        content = await pictures.of(
            (name, convention, theme), partial(_drawn, name, convention, theme)
        )
        return SvgResponse(content, headers=figure_headers(theme))

    return router


def hint_for(exercise: Exercise, body: HintRequest, most: FeedbackLevel) -> Hint:
    """Return the requested step of a hint. Raises ProblemError."""
    require_parts(exercise, ((part, ("answers", part)) for part in body.answers))
    require_parts(exercise, [(body.part, ("part",))])
    submission = body.submission(least(exercise.feedback, most, FeedbackLevel.HINTS))
    if submission.feedback is not FeedbackLevel.HINTS:
        raise ProblemError(
            HTTPStatus.FORBIDDEN,
            say("Reports on this exercise have no messages, and so no hints."),
            "no-hints",
            say("There are no hints"),
        )
    topic = Topic(body.part, body.code, body.row, body.cell)
    step = None
    # Otherwise nothing is read.
    if may_have_hints(topic, submission.answers):
        told = report_on_part(exercise, submission, topic.part)
        step = hint_step(exercise, topic, body.step, submission.answers, told)
    if step is None:
        raise ProblemError(
            HTTPStatus.NOT_FOUND,
            say("The report on these answers has no such message, or there is no hint for it."),
            "no-hint",
            say("There is no hint"),
        )
    picture = step.rule and f"v1/rules/{step.convention}/{step.rule}.svg"
    lesson = step.screen and f"learn-dh?convention={step.convention}#{step.screen}"
    return Hint(
        step=body.step,
        steps=STEPS,
        title=step.title,
        text=step.text,
        picture=picture or None,
        lesson=lesson or None,
    )


def choices_for(exercise: Exercise, body: ChoicesRequest) -> FrameChoices:
    """Return alternatives to a submitted table if it is correct. Raises ProblemError."""
    require_parts(exercise, [(body.part, ("part",))])
    part = exercise.part(body.part)
    found = []
    if isinstance(part, DhTableSpec):
        rows = [row.model_dump() for row in body.rows]
        found = other_choices(exercise, part, rows, Submission({}, body.angle_unit))
    tables = [
        ValidTable(change=each.change, rows=[TableRow(**row) for row in each.rows])
        for each in found
    ]
    return FrameChoices(choices=tables)


def _drawn(rule: RuleName, convention: Convention, theme: Theme) -> bytes:
    return rule_picture(rule, convention, theme).encode()
