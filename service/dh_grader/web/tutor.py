"""The pages for tutors (home, solutions, editor, class, attempts), and the routes that they call.

What the editor and the report on a class compute is in ``tutor_checks.py``; the pages of courses
are in ``courses.py``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, NamedTuple

from fastapi import APIRouter, Request
from markupsafe import Markup
from pydantic import Field
from starlette.responses import HTMLResponse, JSONResponse, Response

from dh_grader.api.http import (
    NO_STORE,
    BoundedWork,
    Catalogue,
    ChunkedResponse,
    MemoizedResults,
    ProblemError,
    exercise_or_404,
    language_headers,
    language_of,
    reachable_exercises,
    read_body,
    told_json,
)
from dh_grader.api.permissions import Access, is_at_the_machine, require_reach
from dh_grader.catalogue import CatalogueError, Exercise, FeedbackLevel, Robot, in_language
from dh_grader.catalogue.load import Drafts
from dh_grader.formats.texts import own_html
from dh_grader.lti import PlatformThreads
from dh_grader.regex import regex
from dh_grader.solutions import solve
from dh_grader.translations import Language, say, told
from dh_grader.typeset import formula_html
from dh_grader.web.pages import (
    FORM_HEADERS,
    PRIVATE_HEADERS,
    Assets,
    page,
    page_answer,
    policy,
)
from dh_grader.web.tutor_checks import (
    Checking,
    CheckRequest,
    ExerciseFolder,
    ImportRequest,
    SaveRequest,
    class_archive,
    exercise_of,
    imported,
    unpacked,
)

if TYPE_CHECKING:
    from dh_grader.store.attempt_store import AttemptStore


# --- The routes of the pages for tutors, and the routes that these pages call


@dataclass(frozen=True, slots=True)
class Tutoring:
    """The settings of the pages for tutors.

    ``access`` decides who sees solutions. ``records`` is True if attempts are recorded, in
    ``store``. ``feedback`` is the highest feedback level for students. ``folders`` have the
    exercise files, and the editor saves in ``editor_dir``. ``checking`` checks the text in the
    editor. ``drafts`` has the exercises in the preview. ``platforms`` are the threads that wait for
    learning platforms.
    """

    access: Access
    folders: Sequence[Path] = field(default=())
    editor_dir: Path | None = None
    records: bool = False
    store: "AttemptStore | None" = None
    checking: Checking = field(default_factory=Checking)
    drafts: Drafts = field(default_factory=Drafts)
    feedback: FeedbackLevel = FeedbackLevel.FULL
    platforms: PlatformThreads = field(default_factory=PlatformThreads)

    def close(self) -> None:
        """End the processes and threads."""
        self.checking.close()
        self.platforms.close()


def tutor_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages for tutors, and those that these pages call."""
    access = tutoring.access
    router = APIRouter(include_in_schema=False)
    work = BoundedWork()
    has_lti = tutoring.store is not None and access.keys is not None and bool(access.keys.secret)
    folder = ExerciseFolder(tutoring.folders, tutoring.editor_dir)
    for routes in (
        _solution_routes(catalogue, assets, access),
        editor_routes(catalogue, assets, folder, work, tutoring.checking, tutoring.drafts),
        class_routes(catalogue, assets, work),
    ):
        router.include_router(routes)

    @router.get("/tutor")
    async def home(request: Request) -> Response:
        """Return the home page of tutors, with the exercises that the caller's key is for."""
        caller = access.caller(request)
        shown = reachable_exercises(catalogue, caller)
        content = tutor_page(
            shown,
            assets,
            language_of(request),
            of_all=caller.reaches_all,
            has_courses=tutoring.records and caller.exercises is None,
            has_platforms=has_lti and caller.reaches_all,
            signed_in=access.is_signed_in(request),
        )
        return page_answer(request, content, FORM_HEADERS)

    return router


def _solution_routes(catalogue: Catalogue, assets: Assets, access: Access) -> APIRouter:
    router = APIRouter(prefix="/tutor")
    solutions, figures, named = MemoizedResults(), MemoizedResults(), MemoizedResults()

    @router.get("/solutions/{exercise_id}")
    async def solution(request: Request, exercise_id: str) -> Response:
        """Return the page with the correct answers to an exercise."""
        exercise = exercise_or_404(catalogue, exercise_id)
        of_all = access.caller(request).reaches_all
        language = language_of(request)
        key = (exercise.id, exercise.version, exercise.title, of_all, language.code)
        drawn = partial(solution_page, exercise, assets, language, of_all=of_all)
        content = await solutions.of(key, drawn)
        headers = {**PRIVATE_HEADERS, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="text/html")

    @router.get("/misconceptions/{exercise_id}")
    async def misconceptions(request: Request, exercise_id: str) -> Response:
        """Return the page with the mistakes that the grader can name in an exercise."""
        exercise = exercise_or_404(catalogue, exercise_id)
        language = language_of(request)
        key = (exercise.id, exercise.version, exercise.title, language.code)
        drawn = partial(misconceptions_page, exercise, catalogue, assets, language)
        content = await named.of(key, drawn)
        headers = {**PRIVATE_HEADERS, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="text/html")

    @router.get("/solutions/{exercise_id}/frames.svg")
    async def frames(exercise_id: str) -> Response:
        """Return a drawing of the robot with the frames of its correct table."""
        exercise = exercise_or_404(catalogue, exercise_id)
        if not isinstance(exercise.reference, Robot):
            raise ProblemError(HTTPStatus.NOT_FOUND, say("The exercise has no frames to draw."))
        key = (exercise.id, exercise.version, exercise.title, exercise.view)
        content = await figures.of(key, partial(_frames, exercise))
        return Response(content, headers=NO_STORE, media_type="image/svg+xml")

    return router


def _frames(exercise: Exercise) -> bytes:
    from dh_grader.figures import reference_figure

    return reference_figure(exercise).encode()


# --- The pages for tutors as HTML


# The start of tables in LaTeX. Model solutions have cells between dollars, and a line for each row.
_TABULAR: Final = r"\begin{tabular}"


def tutor_page(
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    *,
    of_all: bool = True,
    has_courses: bool = False,
    has_platforms: bool = False,
    signed_in: bool = False,
) -> bytes:
    """Return the home page of tutors, with links to all pages for tutors.

    Without ``of_all``, it has no links to the editor and the report on a class.
    """
    return _page(
        "home",
        assets,
        "",
        language=language,
        exercises=[in_language(each, language) for each in catalogue.values()],
        of_all=of_all,
        has_courses=has_courses,
        has_platforms=has_platforms,
        signed_in=signed_in,
    )


def solution_page(
    exercise: Exercise, assets: Assets, language: Language, *, of_all: bool = True
) -> bytes:
    """Return the page with the correct answers to an exercise, and the steps to find them.

    Without ``of_all``, it has no link to the editor.
    """
    exercise = in_language(exercise, language)
    solution = solve(exercise)
    pose, answered = solution.pose, [part.text for part in solution.parts]
    return _page(
        "solution",
        assets,
        "../../",
        language=language,
        exercise=exercise,
        of_all=of_all,
        has_frames=isinstance(exercise.reference, Robot),
        solution=solution,
        links=() if any(part.holds_links for part in exercise.parts) else solution.links,
        pose=None if pose is None or pose.text in answered else pose,
        formula=_formula,
        is_table=lambda latex: latex.startswith(_TABULAR),
        spoken=_spoken,
        table_of=_table_of,
    )


def misconceptions_page(
    exercise: Exercise, catalogue: Catalogue, assets: Assets, language: Language
) -> bytes:
    """Return the page with all mistakes that the grader can name in an exercise."""
    # Imported here, because it loads an algebra system.
    from dh_grader.authoring import misconceptions_of

    return _page(
        "misconceptions",
        assets,
        "../../",
        language=language,
        exercise=in_language(exercise, language),
        misconceptions=misconceptions_of(exercise, catalogue),
        told=lambda sentence: told(sentence, language.translation),
    )


def editor_page(
    exercise_id: str,
    text: str,
    mark: str,
    assets: Assets,
    language: Language,
    *,
    can_write: bool,
    copied: str = "",
) -> bytes:
    """Return the page of the editor with this text.

    ``copied`` is the id of the exercise from which the text was copied, or "".
    """
    return _page(
        "editor",
        assets,
        "../",
        "editor.js",
        language=language,
        exercise_id=exercise_id,
        text=text,
        mark=mark,
        can_write=can_write,
        copied=copied,
    )


def class_page(catalogue: Catalogue, assets: Assets, language: Language) -> bytes:
    """Return the page on which a tutor uploads the files of a class."""
    exercises = [in_language(each, language) for each in catalogue.values()]
    return _page("class", assets, "../", "class.js", language=language, exercises=exercises)


def _page(
    name: str,
    assets: Assets,
    root: str,
    *scripts: str,
    styles: Sequence[str] = ("tutor.css",),
    **values: Any,
) -> bytes:
    return page(
        f"web/templates/tutor/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=styles,
        tutor=True,
        **values,
    )


def _table_of(latex: str) -> tuple[list[str], list[tuple[str, list[str]]]]:
    """Return the column names of a LaTeX table, and its rows as pairs of label and cells."""
    lines = [line.removesuffix(r" \\") for line in latex.split("\n") if line.endswith(r" \\")]
    names, *rows = ([cell.strip("$") for cell in line.split(" & ")] for line in lines)
    return names, [(label, cells) for label, *cells in rows]


def _spoken(latex: str) -> str:
    """Return a name in LaTeX as plain words, to be read aloud."""
    return latex.translate(str.maketrans("_", " ", "\\{}"))


def _formula(latex: str) -> Markup:
    """Return a formula of a model solution as MathML."""
    return own_html(formula_html(latex, display=latex.startswith(("\\begin", "A_"))))


# --- The routes of the editor for exercise files


_NEW: Final = "my-exercise"


class DraftRequest(CheckRequest):
    """The text of an exercise to preview.

    ``draft`` is the id of the stored draft that it replaces.
    """

    draft: Annotated[str, Field(max_length=64)] = ""


def editor_routes(
    catalogue: Catalogue,
    assets: Assets,
    folder: ExerciseFolder,
    work: BoundedWork,
    checking: Checking,
    drafts: Drafts,
) -> APIRouter:
    """Return the routes of the editor for exercise files."""
    router = APIRouter(prefix="/tutor")

    @router.get("/editor")
    async def editor(request: Request, exercise: str | None = None) -> Response:
        """Return the editor of an exercise's file, or of a new file."""
        # Imported here, because it loads an algebra system.
        from dh_grader.authoring import exercise_template

        exercise_id = exercise or _NEW
        file = folder.opened(exercise_id)
        if file is None and exercise is not None:
            exercise_or_404(catalogue, exercise)
        text, mark = (file.text, file.mark) if file else (exercise_template(exercise_id), "")
        is_copy = file is not None and not mark
        page = editor_page(
            folder.free_id(exercise_id) if is_copy else exercise_id,
            text,
            mark,
            assets,
            language_of(request),
            can_write=folder.can_write and is_at_the_machine(request),
            copied=exercise_id if is_copy else "",
        )
        return page_answer(request, page, PRIVATE_HEADERS)

    @router.post("/check")
    async def check(request: Request) -> Response:
        """Return the findings on the text of an exercise file; do not store the text."""
        body = await read_body(CheckRequest, request)
        language = language_of(request)
        content = await work.do(partial(checking.checked, body, language))
        return told_json(content, language, headers=NO_STORE)

    @router.post("/import")
    async def import_robot(request: Request) -> Response:
        """Return the text of an exercise file for an imported robot; do not store it."""
        body = await read_body(ImportRequest, request)
        language = language_of(request)
        content = await work.do(partial(imported, body, language))
        return told_json(content, language, headers=NO_STORE)

    @router.post("/drafts")
    async def draft(request: Request) -> Response:
        """Store a draft of an exercise for the preview, and return the draft's id."""
        body = await read_body(DraftRequest, request)
        draft_id = await work.do(partial(_put, drafts, body))
        return JSONResponse({"draft": draft_id}, headers=NO_STORE)

    @router.post("/files")
    async def save(request: Request) -> Response:
        """Save an exercise file in the editor's folder."""
        if folder.can_write and not is_at_the_machine(request):
            raise ProblemError(
                HTTPStatus.FORBIDDEN,
                say("Files can be saved only from the machine of the service."),
            )
        body = await read_body(SaveRequest, request)
        mark = await work.do(partial(folder.save, body))
        return JSONResponse({"mark": mark}, headers=NO_STORE)

    return router


def _put(drafts: Drafts, body: DraftRequest) -> str:
    """Store a draft of an exercise, and return the draft's id. Raises ProblemError."""
    try:
        exercise_of(body.id, body.text)
        return drafts.put(body.text, body.draft)
    except CatalogueError as error:
        raise ProblemError(
            HTTPStatus.UNPROCESSABLE_ENTITY,
            say("The file cannot be used. Fix it first."),
            "unusable-exercise",
            say("There is nothing to preview"),
        ) from error
    except OSError as error:
        raise ProblemError(
            HTTPStatus.SERVICE_UNAVAILABLE,
            say("The service has no writable folder for temporary files. Set TMPDIR to one."),
        ) from error


# --- The routes of the page that grades the files of a class


_HEADERS: Final = {**PRIVATE_HEADERS, "Content-Security-Policy": policy(frame_src="'self'")}


def class_routes(catalogue: Catalogue, assets: Assets, work: BoundedWork) -> APIRouter:
    """Return the routes of the page that grades the files of a class."""
    router = APIRouter(prefix="/tutor")

    @router.get("/class")
    async def class_form(request: Request) -> Response:
        """Return the form for uploading the files of a class."""
        return page_answer(request, class_page(catalogue, assets, language_of(request)), _HEADERS)

    @router.get("/class/report")
    async def class_frame() -> Response:
        """Return the empty page in which the browser shows reports."""
        # The Content-Security-Policy of the page allows the style sheets of the reports.
        from dh_grader.formats.class_page import STYLE as INDEX_STYLE
        from dh_grader.formats.documents import STYLE as REPORT_STYLE

        own = policy(
            script_src="'none'",
            connect_src="'none'",
            style_src=f"'{INDEX_STYLE.hash}' '{REPORT_STYLE.hash}'",
        )
        content = '<!doctype html><html lang="en"><head><title>Report</title></head></html>'
        return HTMLResponse(content, headers={**PRIVATE_HEADERS, "Content-Security-Policy": own})

    @router.post("/class")
    async def report(request: Request) -> Response:
        """Grade a class, and return the reports as a ZIP file; store nothing."""
        packed = await request.body()
        language = language_of(request)
        content = await work.do(lambda: class_archive(unpacked(packed), catalogue, language))
        headers = {**NO_STORE, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="application/zip")

    return router


# --- The routes of the pages of recorded attempts
#
# Scripts load the attempts themselves.


class CoursePlace(NamedTuple):
    """The course and the assignment whose attempts a page shows; "" means all."""

    course: str = ""
    assignment: str = ""


_NAME: Final = regex(r"[a-z0-9-]{1,64}", re.ASCII)


def attempt_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages of recorded attempts."""
    router = APIRouter(prefix="/tutor", include_in_schema=False)
    access = tutoring.access

    def answer(request: Request, shown: bytes, root: str) -> Response:
        if not tutoring.records:
            shown = nothing_recorded_page(assets, language_of(request), root)
        return page_answer(request, shown, PRIVATE_HEADERS)

    @router.get("/attempts")
    async def attempts(request: Request, exercise: str | None = None) -> Response:
        """Return the page with the list of attempts."""
        # If the caller's key is restricted to some exercises, the page lists one of these exercises
        # at a time.
        caller = access.caller(request)
        require_reach(caller, exercise or None)
        shown = reachable_exercises(catalogue, caller)
        drawn = attempts_page(
            shown,
            assets,
            language_of(request),
            _place(request),
            of_all=caller.exercises is None,
            forgets=caller.reaches_all,
        )
        return answer(request, drawn, "../")

    @router.get("/attempts/{attempt_id}")
    async def attempt(request: Request, attempt_id: str) -> Response:
        """Return the page of an attempt."""
        return answer(request, attempt_page(attempt_id, assets, language_of(request)), "../../")

    @router.get("/statistics/{exercise_id}")
    async def statistics(request: Request, exercise_id: str) -> Response:
        """Return the page with an exercise's statistics."""
        exercise = exercise_or_404(catalogue, exercise_id)
        drawn = statistics_page(exercise, assets, language_of(request), _place(request))
        return answer(request, drawn, "../../")

    return router


def _place(request: Request) -> CoursePlace:
    # Return the course and the assignment in the address of a page, if they are well formed.
    given = request.query_params
    course, assignment = given.get("course", ""), given.get("assignment", "")
    if not _NAME.fullmatch(course):
        return CoursePlace()
    return CoursePlace(course, assignment if _NAME.fullmatch(assignment) else "")


# --- The pages of recorded attempts as HTML, which scripts fill


_STYLES: Final = ("tutor.css", "records.css")


def attempts_page(
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    place: CoursePlace,
    *,
    of_all: bool = True,
    forgets: bool = True,
) -> bytes:
    """Return the page with the list of attempts, its filters, the export, and the deletion.

    Without ``of_all``, the page shows one exercise at a time. Without ``forgets``, the page has no
    deletion, which concerns all exercises and courses.
    """
    all_of_them = [("", say("All exercises"))] if of_all else []
    titles = ((each.id, in_language(each, language).title) for each in catalogue.values())
    choices = [*all_of_them, *titles]
    return _page(
        "attempts",
        assets,
        "../",
        "attempts.js",
        styles=_STYLES,
        language=language,
        choices=choices,
        forgets=forgets,
        **place._asdict(),
    )


def attempt_page(attempt_id: str, assets: Assets, language: Language) -> bytes:
    """Return the page of an attempt: the answers, their report, and the tutor's points."""
    return _page(
        "attempt",
        assets,
        "../../",
        "attempt.js",
        styles=_STYLES,
        language=language,
        attempt_id=attempt_id,
    )


def statistics_page(
    exercise: Exercise, assets: Assets, language: Language, place: CoursePlace
) -> bytes:
    """Return the page with an exercise's statistics, the export of attempts, and the regrade."""
    return _page(
        "statistics",
        assets,
        "../../",
        "statistics.js",
        styles=_STYLES,
        language=language,
        exercise=in_language(exercise, language),
        **place._asdict(),
    )


def nothing_recorded_page(assets: Assets, language: Language, root: str) -> bytes:
    """Return the page that explains how to start the service with recording of attempts."""
    return _page("nothing_recorded", assets, root, styles=_STYLES, language=language)
