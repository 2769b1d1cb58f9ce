"""The routes that grade without recording, and those around: exercises, hints, solutions, tokens.

Attempts are recorded in ``recording.py``. What an assignment allows is in ``grading_gates.py``.
"""

import asyncio
import logging
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from fastapi import APIRouter, Path, Query, Request, Response
from pydantic import BaseModel, TypeAdapter

from dh_grader.access import Caller
from dh_grader.api.document import MAY_NEED_KEY, answers, posting, refusals
from dh_grader.api.frames import SvgResponse, figure_headers
from dh_grader.api.grading_gates import (
    OwnVariants,
    PracticeGate,
    of_assignment,
    solution_not_shown,
)
from dh_grader.api.http import (
    Catalogue,
    ExerciseId,
    Location,
    MemoizedResults,
    Monitor,
    ProblemError,
    exercise_or_404,
    failed,
    give_way,
    in_languages,
    invalid,
    language_headers,
    language_of,
    private,
    private_json,
    read_body,
    require_exercises,
    require_parts,
    run_in_turns,
    store_down,
    told_json,
    validated,
)
from dh_grader.api.permissions import Access, count_submissions, require_reach
from dh_grader.catalogue import Exercise, FeedbackLevel, in_language, least
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import (
    ChoicesRequest,
    ExerciseList,
    ExerciseView,
    FrameChoices,
    GradeManyResponse,
    Hint,
    HintRequest,
    PracticeRobot,
    TableRow,
    TokenRequest,
    TokenResponse,
    ValidTable,
)
from dh_grader.figures.drawing import Theme
from dh_grader.formats.documents import rendered
from dh_grader.formats.graded import report_in
from dh_grader.grading import Report, Submission, grade, is_all_right, report_on_part
from dh_grader.grading.kinds.tables import shown_shape
from dh_grader.hints import (
    RULES,
    STEPS,
    Topic,
    hint_step,
    may_have_hints,
    other_choices,
    rule_picture,
)
from dh_grader.kinematics import Convention
from dh_grader.slices import working_time
from dh_grader.solutions import ModelSolution, solve
from dh_grader.store import StoreDownError
from dh_grader.submissions.bodies import ExerciseSubmission, GradeManyRequest, GradeRequest
from dh_grader.translations import Language, say
from dh_grader.typeset import statement_html
from dh_grader.variants.robots import (
    Situation,
    asks_enough,
    candidates,
    difficulty_of,
    has_situation,
    practice_id,
)

if TYPE_CHECKING:
    from dh_grader.store.attempt_store import AttemptStore


# --- The routes that grade submissions


_log = logging.getLogger(__name__)


def grading_routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    access: Access,
    monitor: Monitor | None,
    practice: PracticeGate,
    own: OwnVariants,
) -> APIRouter:
    """Return the routes that grade; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["grading"])

    # Gradings run on the event loop: each is a millisecond of pure Python, which threads cannot
    # run in parallel, and changing threads would take another tenth of that.
    @router.post(
        "/exercises/{exercise_id}/grade",
        operation_id="grade",
        summary="Grade a submission",
        response_description="The report.",
        **in_languages(of_assignment(posting(GradeRequest, Report, "grade", HTTPStatus.NOT_FOUND))),
    )
    async def grade_one(exercise_id: ExerciseId, request: Request) -> Response:
        """Grade answers, row by row and cell by cell. Nothing is recorded.

        The answer is a report, whatever a student wrote: an entry that cannot be read is
        `unreadable`, with the reason, and everything else is graded. The same answers
        always get the same report, in the language of the reader. It says no more than the
        exercise and the service allow; `feedback` may ask for less.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check(access.caller(request), exercise.plain_id)
        body = await read_body(GradeRequest, request)
        language = language_of(request)
        report = await run_in_turns(request, lambda: _report(exercise, body, (), language))
        return told_json(report, language)

    @router.post(
        "/grade",
        operation_id="gradeMany",
        summary="Grade many submissions",
        response_description="A result for each submission, in their order.",
        **in_languages(posting(GradeManyRequest, GradeManyResponse, "grade-many")),
    )
    async def grade_many(request: Request) -> Response:
        """Grade submissions to any exercises, each as if it were alone. Nothing is recorded.

        Each submission counts as a request towards the limits of the service. If they do not allow
        all submissions now, the answer is 429, and nothing is graded.

        The results have the order of the submissions. If a submission cannot be graded
        because its exercise or one of its parts does not exist, its result is a problem;
        the others are graded.
        """
        caller, language = access.caller(request), language_of(request)
        body = await read_body(GradeManyRequest, request)
        await count_submissions(request, len(body.submissions))
        results = []
        for i, submission in enumerate(body.submissions):
            if i:
                await give_way(request)
            graded = partial(_result, submission, i, request.url.path, caller, language)
            refused = await practice.refusal(caller, _named(submission))
            results.append(
                _problem(refused, request.url.path, i, language)
                if refused
                else await run_in_turns(request, graded)
            )
        content = b'{"results":[%b]}' % b",".join(results)
        return told_json(content, language)

    def _result(value: object, i: int, path: str, caller: Caller, language: Language) -> bytes:
        at = ("submissions", i)
        try:
            submission = validated(ExerciseSubmission, value, at)
            require_reach(caller, submission.exercise)
            exercise = exercise_or_404(catalogue, submission.exercise)
            return b'{"report":%b}' % _report(exercise, submission, at, language)
        except ProblemError as error:
            problem = error
        except Exception:  # noqa: BLE001 -- the other submissions are graded all the same
            _log.exception("submission %d of a request could not be graded", i)
            problem = failed()
        return _problem(problem, path, i, language)

    def _report(exercise: Exercise, body: GradeRequest, at: Location, language: Language) -> bytes:
        require_parts(exercise, ((part, (*at, "answers", part)) for part in body.answers))
        submission = body.submission(least(exercise.feedback, feedback))
        began = working_time()
        report = grade(exercise, submission)
        if monitor is not None:
            monitor.graded(report, working_time() - began)
        return rendered(report_in(report, language))

    return router


def _named(submission: object) -> str:
    exercise = submission.get("exercise") if isinstance(submission, dict) else None
    return exercise.partition("~")[0] if isinstance(exercise, str) else ""


def _problem(problem: ProblemError, path: str, i: int, language: Language) -> bytes:
    content = problem.content(f"{path}#/submissions/{i}", language=language)
    return b'{"problem":%b}' % content


# --- The routes that list and describe exercises, without their correct answers


def exercises_routes(catalogue: Catalogue, feedback: FeedbackLevel, own: OwnVariants) -> APIRouter:
    """Return the routes that list and describe exercises.

    ``feedback`` is the highest feedback level of reports.
    """
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])

    # The models take the public fields from the attributes of the exercises.
    @router.get(
        "",
        operation_id="listExercises",
        summary="List the exercises",
        response_model=ExerciseList,
        response_description="The catalogue.",
        **in_languages({}),
    )
    async def list_exercises(request: Request, response: Response) -> dict[str, Any]:
        """List all exercises, by level, then by their place within it."""
        language = language_of(request)
        response.headers.update(language_headers(language))
        return {"exercises": [in_language(each, language) for each in catalogue.values()]}

    @router.get(
        "/{exercise_id}",
        operation_id="getExercise",
        summary="Show an exercise",
        response_model=ExerciseView,
        response_description="The exercise.",
        response_model_exclude_none=True,
        **in_languages(
            of_assignment({"responses": refusals(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND)})
        ),
    )
    async def show_exercise(
        exercise_id: ExerciseId, request: Request, response: Response
    ) -> dict[str, Any]:
        """Show an exercise: its statement, its symbols, and what each part asks for."""
        language = language_of(request)
        response.headers.update(language_headers(language))
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        exercise = in_language(exercise, language)
        fields = {name: getattr(exercise, name, None) for name in ExerciseView.model_fields}
        parts = [
            {
                **dict(part),
                "prompt_html": statement_html(part.prompt, exercise.symbols),
                "shape": shown_shape(part, exercise),
            }
            for part in exercise.parts
        ]
        return {
            **fields,
            "statement_html": statement_html(exercise.statement, exercise.symbols),
            "figure": exercise.reference is not None,
            "feedback": least(exercise.feedback, feedback),
            "symbols": exercise.variables,
            "parts": parts,
        }

    return router


# --- The routes for hints, for pictures of DH rules, and for alternatives to a correct table


_RULE = Path(max_length=60, description="The name of a rule.", examples=["link_twist"])


def hints_routes(
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
            (name, convention, theme), lambda: rule_picture(name, convention, theme).encode()
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


# --- The route that gives students generated robots to practise with


_LEVEL = Query(ge=1, le=4, description="From 1, robots with two or three joints, to 4.")
_CONVENTION = Query(description="The DH convention of the table.")
_AFTER = Query(
    max_length=60,
    description="The id of the last robot. Robots that are dealt after one another are not alike.",
)
_FAVOUR = Query(description="A situation that the robot should have.")


def practice_routes(catalogue: Catalogue) -> APIRouter:
    """Return the route that chooses a generated robot.

    ``catalogue`` contains all generated robots as exercises.
    """
    router = APIRouter(prefix="/v1/practice", tags=["exercises"])

    @router.get(
        "/next",
        operation_id="getNextRobot",
        summary="Deal a generated robot",
        response_model=PracticeRobot,
        response_description="The robot.",
        responses=refusals(HTTPStatus.UNPROCESSABLE_ENTITY),
        openapi_extra=MAY_NEED_KEY,
    )
    async def deal(
        request: Request,
        level: Annotated[int, _LEVEL] = 1,
        convention: Annotated[Convention, _CONVENTION] = Convention.STANDARD,
        after: Annotated[str | None, _AFTER] = None,
        favour: Annotated[Situation | None, _FAVOUR] = None,
    ) -> PracticeRobot:
        """Deal a robot to practise with: any one, or the next one after another.

        An id always means the same robot. Robots are not recorded and not in the list of
        exercises; show, draw and grade them by their ids.
        """
        last = None if after is None else practice_id(after)
        if after is not None and last is None:
            message = say("This is not the id of a practice robot.")
            detail = {"type": "unknown", "loc": ("after",), "msg": message}
            raise invalid([detail])
        chosen = None
        for chosen in candidates(level, convention, last):
            # A look takes a millisecond and a grading more, so others work in between.
            await give_way(request)
            if favour is not None and not has_situation(chosen, favour):
                continue
            if await run_in_turns(request, partial(asks_enough, catalogue[str(chosen)])):
                break
        assert chosen is not None
        return PracticeRobot(
            id=str(chosen), level=level, convention=convention, difficulty=difficulty_of(chosen)
        )

    return router


# --- The routes that show model solutions: to tutors, and to students with full marks


_SOLUTION: Final = TypeAdapter(ModelSolution)


def solutions_routes(
    catalogue: Catalogue, access: Access, practice: PracticeGate, own: OwnVariants
) -> APIRouter:
    """Return the routes that show model solutions."""
    router = APIRouter(prefix="/v1/exercises", tags=["solutions"])
    solutions = SolvedExercises()

    @router.get(
        "/{exercise_id}/solution",
        operation_id="getSolution",
        summary="Show the model solution",
        response_description="The model solution.",
        responses=answers(
            ModelSolution, "solution-response", HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND
        ),
        openapi_extra=MAY_NEED_KEY,
    )
    async def show_solution(exercise_id: ExerciseId) -> Response:
        """Show the right answer to each part, each link transform and the pose, for tutors."""
        return await solutions.answer(exercise_or_404(catalogue, exercise_id))

    @router.post(
        "/{exercise_id}/solution",
        operation_id="getSolutionForRightAnswers",
        summary="Show the model solution for right answers",
        response_description="The model solution.",
        **of_assignment(
            posting(GradeRequest, ModelSolution, None, HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND)
        ),
    )
    async def show_solution_for_right_answers(
        exercise_id: ExerciseId, request: Request
    ) -> Response:
        """Show the model solution to a student whose answers have full marks in all parts.

        An exercise that counts has none: its assignment says when its solution is shown.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check_solution(access.caller(request), exercise.plain_id)
        if exercise.attempts != AttemptsSpec():
            raise _not_shown()
        body = await read_body(GradeRequest, request)
        require_parts(exercise, ((part, ("answers", part)) for part in body.answers))
        submission = body.submission(FeedbackLevel.SCORE)
        if not await run_in_turns(request, partial(is_all_right, exercise, submission)):
            raise _not_shown()
        return await solutions.answer(exercise)

    return router


def _not_shown() -> ProblemError:
    return solution_not_shown(
        say("The solution is shown after full marks, and not for exercises that count.")
    )


class SolvedExercises:
    """The model solutions of exercises, memoized."""

    def __init__(self) -> None:
        self._memoized = MemoizedResults()

    async def answer(self, exercise: Exercise) -> Response:
        """Return the model solution of an exercise as JSON."""
        key = (exercise.id, exercise.version)
        content = await self._memoized.of(key, partial(_solved, exercise))
        return private_json(content)


def _solved(exercise: Exercise) -> bytes:
    return _SOLUTION.dump_json(solve(exercise), exclude_none=True)


# --- The route that makes tokens for learners


def tokens_routes(catalogue: Catalogue, access: Access) -> APIRouter:
    """Return the route that makes tokens for learners."""
    router = APIRouter(prefix="/v1", tags=["tokens"])

    @router.post(
        "/tokens",
        operation_id="createToken",
        summary="Make a token for a learner",
        response_description="The token.",
        status_code=HTTPStatus.CREATED,
        **posting(
            TokenRequest,
            TokenResponse,
            "token",
            HTTPStatus.NOT_FOUND,
            success=HTTPStatus.CREATED,
        ),
    )
    async def create_token(request: Request) -> Response:
        """Make a token. A learner's browser grades, records and reads its own attempts with it.

        A page with a token calls the service without showing the key. The token has no
        right that its key does not have, and expires no later than the key. The service
        does not store it.
        """
        caller = access.caller(request)
        body = await read_body(TokenRequest, request)
        exercises = caller.exercises
        if body.exercises is not None:
            require_exercises(catalogue, body.exercises, "exercises")
            for exercise in body.exercises:
                require_reach(caller, exercise)
            exercises = frozenset(body.exercises)
        # A token has no fractions of seconds.
        now = datetime.now(UTC).replace(microsecond=0)
        expires_at = now + timedelta(minutes=body.minutes)
        learner = replace(caller, learner=body.learner, exercises=exercises)
        token = access.token(learner, expires_at)
        answer = TokenResponse(token=token, learner=body.learner, expires_at=expires_at)
        return private(answer, HTTPStatus.CREATED)

    return router


# --- The routes for health checks


# The seconds that the database may take to answer.
_PATIENCE: Final = 3.0


class Alive(BaseModel):
    """The answer of a process that is alive."""

    status: Literal["ok"] = "ok"


class Ready(BaseModel):
    """The answer of a service with exercises."""

    status: Literal["ready"] = "ready"
    exercises: int


def health_routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes for health checks."""
    router = APIRouter(tags=["health"])
    checks = None if store is None else _Checks(store)

    @router.get(
        "/healthz",
        operation_id="getLiveness",
        summary="Is the service alive?",
        response_description="It answers.",
    )
    async def alive() -> Alive:
        """Answer if the process is alive."""
        return Alive()

    @router.get(
        "/readyz",
        operation_id="getReadiness",
        summary="Is the service ready?",
        response_description="It is ready.",
        responses=refusals(HTTPStatus.SERVICE_UNAVAILABLE),
    )
    async def ready() -> Ready:
        """Say whether the service can grade submissions and, if it has a database, record them."""
        exercises = len(catalogue)
        if not exercises:
            raise ProblemError(
                HTTPStatus.SERVICE_UNAVAILABLE,
                "No exercise is loaded.",
                "no-exercises",
                "The service has nothing to grade",
                headers={"Retry-After": "5"},
            )
        if checks is not None:
            try:
                await checks.passed()
            except StoreDownError as error:
                raise store_down(say("The database does not answer.")) from error
        return Ready(exercises=exercises)

    return router


class _Checks:
    # Checks the database once at a time; requests that arrive during a check share it.
    def __init__(self, store: "AttemptStore") -> None:
        self._store = store
        self._under_way: asyncio.Task[None] | None = None

    async def passed(self) -> None:
        if self._under_way is None or self._under_way.done():
            self._under_way = asyncio.create_task(self._check())
        # If one client goes away, the others still wait for the check.
        await asyncio.shield(self._under_way)

    async def _check(self) -> None:
        try:
            await asyncio.wait_for(self._store.check(), _PATIENCE)
        except TimeoutError as error:
            raise StoreDownError(f"the database does not react within {_PATIENCE:g} s") from error
