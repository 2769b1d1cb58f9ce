"""The pages that learning platforms open here: exercises, the choice of links, reports on files.

The routes are in ``lti_routes.py``, and what launches and links mean is in ``dh_grader.lti``.
"""

import asyncio
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import Any, Final
from zoneinfo import ZoneInfo

from pydantic import ValidationError
from sqlalchemy import Connection

from dh_grader.access import Caller, Keys, Scope, Secret
from dh_grader.api.http import Catalogue, language_headers, message_of
from dh_grader.api.recording import write
from dh_grader.catalogue import Exercise, FeedbackLevel, in_language
from dh_grader.contract.courses import MOST_EXERCISES, CourseAssignment, NewAssignment
from dh_grader.courses import CourseError, moment, roll, zone_named
from dh_grader.courses.assignments import assignments_of
from dh_grader.formats.documents import page_of
from dh_grader.lti import PlatformThreads
from dh_grader.lti.deep_linking import NewLink, begin_linking
from dh_grader.lti.grade_services import AccessTokens, ScoreError, available_key
from dh_grader.lti.handed_files import (
    HandedFiles,
    NoFileError,
    PlatformFiles,
    files_of,
    graded_files,
)
from dh_grader.lti.launch import (
    DEEP_LINKING,
    LTI,
    REPORT,
    SETTINGS,
    Landing,
    LaunchMessage,
    LinkingTicket,
    Login,
    LtiTicket,
    NewLogin,
    check_deployment,
    enter,
    pseudonym,
    signed_ticket,
    use_login,
)
from dh_grader.lti.outbox import utc_now
from dh_grader.lti.registrations import LtiError, LtiRole, Registration
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.translations import Language, joined, say
from dh_grader.web.pages import FORM_HEADERS, Assets, kinds_of, page, policy, words_of

# --- Launches: users who open a link on a learning platform


# The lifetime of the token in a page. The page keeps it in memory; a reload needs a new launch.
TOKEN_LIFETIME: Final = timedelta(hours=12)


class Landings:
    """Records launches, and makes their pages.

    One transaction records a launch and marks its login as used.
    """

    def __init__(
        self,
        catalogue: Catalogue,
        assets: Assets,
        store: AttemptStore,
        keys: Keys,
        secret: Secret,
        platforms: PlatformThreads,
        feedback: FeedbackLevel = FeedbackLevel.FULL,
    ) -> None:
        """``feedback`` is the highest feedback level for students."""
        self.catalogue, self.assets, self.store = catalogue, assets, store
        self.keys, self.secret, self.platforms = keys, secret, platforms
        self.platform_files = PlatformFiles(
            AccessTokens(utc_now, lambda: available_key(store.engine, secret, utc_now()))
        )
        self._reports = ReportPages(
            assets, store, secret, catalogue, feedback, self.platform_files, platforms
        )

    async def page(self, message: LaunchMessage, login: Login, language: Language) -> bytes:
        """Record a launch, and return the page that it opens. Raises LtiError."""
        now = datetime.now(UTC)
        if message.kind == DEEP_LINKING:
            return await self._picker(message, login, now, language)
        if message.kind in (REPORT, SETTINGS):
            return await self._reports.page(message, login, language)

        def entered(connection: Connection) -> Landing:
            use_login(connection, login, now)
            return enter(connection, message, self.secret, self.catalogue, now)

        landing = await write(self.store, entered)
        if landing.key_id:
            self.keys.expect_keys()
        if landing.role is not LtiRole.TUTOR:
            token = self._token(landing, now)
            return landing_page(landing, token, self.catalogue, self.assets, language)
        mine = LtiTicket(
            registration=message.registration.id,
            context=landing.context,
            link=landing.link,
            learner=self._reviewed(message),
        )
        ticket = signed_ticket(mine, self.secret, now)
        if landing.assignment is not None:
            is_review = bool(mine.learner)
            return tutor_page(
                landing, ticket, self.catalogue, self.assets, language, is_review=is_review
            )
        choice = Choice(landing.link_title)
        title = landing.course_title
        return choosing_page(choice, title, ticket, self.catalogue, self.assets, language)

    def _reviewed(self, message: LaunchMessage) -> str:
        """Return the id of the learner whose attempts a tutor wants to see, or ""."""
        if not message.reviewed:
            return ""
        return pseudonym(message.registration.id, message.reviewed, self.secret)

    async def _picker(
        self, message: LaunchMessage, login: Login, now: datetime, language: Language
    ) -> bytes:
        """Return the page on which a tutor chooses links for the platform. Raises LtiError."""

        def begun(connection: Connection) -> Offer:
            use_login(connection, login, now)
            ticket = begin_linking(connection, message, self.secret, now)
            return offer_of(connection, ticket, message.registration)

        offer = await write(self.store, begun)
        text = signed_ticket(offer.ticket, self.secret, now)
        return picker_page(offer, Picked(), text, self.catalogue, self.assets, language)

    def _token(self, landing: Landing, now: datetime) -> str:
        # Return the token for the page of a learner, or of a tutor who previews it and can grade
        # with it, but not record. Guests get no token ("").
        if landing.role is LtiRole.GUEST or not landing.key_id or landing.assignment is None:
            return ""
        is_learner = landing.role is LtiRole.LEARNER
        scopes = {Scope.GRADE, Scope.RECORD} if is_learner else {Scope.GRADE}
        exercises = None
        if not is_learner:
            exercises = frozenset(each.exercise for each in landing.assignment.exercises)
        name = landing.learner or "lti-preview"
        caller = Caller(frozenset(scopes), exercises, name, landing.key_id)
        return self.keys.token(caller, now + TOKEN_LIFETIME)


# --- The pages of launches as HTML, and their HTTP headers


_FOLDER = "web/templates/lti"


def frame_headers(
    language: Language, origins: Iterable[str], *targets: str, style: str = ""
) -> dict[str, str]:
    """Return the HTTP headers of a page that only pages of ``origins`` may show in a frame.

    ``language`` is the language of the page. Forms in the page may be sent only to ``targets``, or
    else only to us. ``style`` is the hash of a style sheet inside the page, which may then use no
    other style.
    """
    # The platform's window must stay the opener of the page, because that window may have the
    # platform's storage.
    ancestors = " ".join(dict.fromkeys(["'self'", *origins]))
    more = {"form_action": " ".join(dict.fromkeys(targets))} if targets else {}
    if style:
        more["style_src"] = f"'{style}'"
    content = policy(frame_ancestors=ancestors, **more)
    headers = {**FORM_HEADERS, **language_headers(language), "Content-Security-Policy": content}
    del headers["Cross-Origin-Opener-Policy"]
    return headers


@dataclass(frozen=True, slots=True)
class Choice:
    """The values that a tutor has entered to choose the exercises of a link."""

    title: str
    search: str = ""
    chosen: Mapping[str, str] | None = None
    message: str = ""
    variants: bool = False


def login_page(login: NewLogin, name: str, assets: Assets, language: Language) -> bytes:
    """Return the page that stores a login's secret in the platform's storage in this browser."""
    return lti_page(
        "login.html",
        assets,
        ["platform_storage.js"],
        language=language,
        address=login.address,
        frame=login.fields["lti_storage_target"],
        origin=login.registration.platform_origin,
        name=name,
        value=login.browser,
    )


def binding_page(
    assets: Assets,
    language: Language,
    window: str,
    *,
    state: str = "",
    token: str = "",
    storage: tuple[str, str, str] | None = None,
) -> bytes:
    """Return the page for a browser that has not sent the cookie of its login.

    ``storage`` has the frame and the origin of the platform's storage, and the name of the stored
    secret. Without it, the page has only a button that opens the address ``window`` in a window of
    its own.
    """
    frame, origin, name = storage or ("", "", "")
    scripts = [] if storage is None else ["platform_storage.js"]
    return lti_page(
        "binding.html",
        assets,
        scripts,
        language=language,
        window=window,
        state=state,
        token=token,
        frame=frame,
        origin=origin,
        name=name,
        has_storage=storage is not None,
    )


def refused_page(
    assets: Assets, language: Language, advice: str, reference: str, reason: str
) -> bytes:
    """Return the page that says why nothing was opened, and what the user can do."""
    return lti_page(
        "refused.html",
        assets,
        [],
        language=language,
        advice=advice,
        reference=reference,
        reason=reason,
    )


def landing_page(
    landing: Landing, token: str, catalogue: Catalogue, assets: Assets, language: Language
) -> bytes:
    """Return the page with exercises that a link opens for a learner, a tutor's preview or a guest.

    The page calls the service with ``token``.
    """
    assignment = landing.assignment
    if landing.learner and assignment is not None:
        return page(
            "web/templates/learn.html",
            assets,
            "../",
            ["page.js", "embed.js", "learner.js"],
            styles=["learner.css"],
            language=language,
            is_framed=True,
            key=token,
            place=_place(landing.course, assignment),
        )
    exercises = [each.exercise for each in assignment.exercises] if assignment and token else []
    return lti_page(
        "visitor.html",
        assets,
        ["embed.js"] if exercises else [],
        language=language,
        role=landing.role.value,
        title=landing.link_title or say("Exercises"),
        is_set_up=assignment is not None,
        token=token,
        exercises=[each for each in exercises if each in catalogue],
    )


def tutor_page(
    landing: Landing,
    ticket: str,
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    *,
    is_review: bool = False,
) -> bytes:
    """Return a tutor's page about a link on the platform, with a form that opens the course.

    With ``is_review``, the form opens the attempts of one learner.
    """
    assert landing.assignment is not None
    return lti_page(
        "tutor.html",
        assets,
        [],
        language=language,
        title=landing.link_title,
        course=landing.course_title,
        assignment=landing.assignment,
        titles={name: in_language(each, language).title for name, each in catalogue.items()},
        ticket=ticket,
        is_review=is_review,
    )


def choosing_page(
    choice: Choice,
    course: str,
    ticket: str,
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return the form on which a tutor chooses the exercises of a link on the platform."""
    chosen = choice.chosen or {}
    return lti_page(
        "choose.html",
        assets,
        [],
        language=language,
        course=course,
        choice=choice,
        chosen=chosen,
        exercises=found(catalogue, language, choice.search, chosen),
        ticket=ticket,
    )


def found(
    catalogue: Catalogue, language: Language, search: str, chosen: Mapping[str, str]
) -> Sequence[tuple[Exercise, str]]:
    """Return the chosen exercises, then those that a search finds, each with its points."""
    words = search.lower().split()

    def has_words(each: Exercise) -> bool:
        known = words_of(each, language, catalogue[each.id]).lower()
        return all(word in known for word in words)

    listed = [
        (each, chosen.get(each.id) or f"{sum(part.points for part in each.parts):g}")
        for each in (in_language(it, language) for it in catalogue.values())
        if each.id in chosen or has_words(each)
    ]
    return sorted(listed, key=lambda it: it[0].id not in chosen)


def _place(course: str, assignment: CourseAssignment) -> str:
    """Return the URL fragment of an assignment's exercise, or "" if it has several."""
    if len(assignment.exercises) != 1:
        return ""
    return f"#/{course}/{assignment.id}/{assignment.exercises[0].exercise}"


def lti_page(
    template: str,
    assets: Assets,
    scripts: list[str],
    more_styles: Iterable[str] = (),
    **values: Any,
) -> bytes:
    """Return the page made from a template for pages in learning platforms."""
    shown = {"is_framed": True, **values}
    styles = ["tutor.css", "records.css", *more_styles]
    path = f"{_FOLDER}/{template}"
    return page(path, assets, "../", ["page.js", *scripts], styles=styles, tutor=False, **shown)


# --- Deep linking: the links that a tutor has chosen in a form


_LONGEST_LINE: Final = 200


class NotYetError(Exception):
    """The values of a tutor's form cannot be used yet; the message says why."""


@dataclass(frozen=True, slots=True)
class Offer:
    """What a tutor can choose from to make links: exercises, or the course's assignments.

    ``zone`` is the time zone of the dates that the tutor enters. ``assignments`` is empty if there
    is no course yet.
    """

    ticket: LinkingTicket
    registration: Registration
    zone: ZoneInfo
    assignments: Sequence[CourseAssignment] = ()


@dataclass(frozen=True, slots=True)
class Picked:
    """The values that a tutor has entered in the form.

    ``points`` has the points of each chosen exercise. ``message`` is the error message to show.
    """

    title: str = ""
    search: str = ""
    points: Mapping[str, str] | None = None
    assignments: Sequence[str] = ()
    opens: str = ""
    due: str = ""
    is_one: bool = True
    variants: bool = False
    message: str = ""

    def with_message(self, message: str) -> "Picked":
        """Return a copy of the form's values with this error message."""
        return replace(self, message=message)


def offer_of(connection: Connection, ticket: LinkingTicket, known: Registration) -> Offer:
    """Return what the tutor with this ticket can choose from."""
    if not ticket.course:
        return Offer(ticket, known, zone_named(known.zone))
    try:
        course = roll.course(connection, ticket.course)
        found = assignments_of(connection, ticket.course)
    except CourseError:
        return Offer(ticket, known, zone_named(known.zone))
    return Offer(ticket, known, zone_named(course.zone), found)


def picked_in(fields: Mapping[str, list[str]]) -> Picked:
    """Return the values that a tutor has entered in the form."""

    def line(name: str) -> str:
        return " ".join(fields.get(name, [""])[0].split())[:_LONGEST_LINE]

    names = fields.get("exercise", [])[:MOST_EXERCISES]
    return Picked(
        title=line("title"),
        search=line("search"),
        points={name: line(f"points:{name}") for name in names},
        assignments=fields.get("assignment", [])[:MOST_EXERCISES],
        opens=line("opens"),
        due=line("due"),
        is_one=line("as") != "several",
        variants=line("variants") == "yes",
    )


def links_of(picked: Picked, offer: Offer, catalogue: Mapping[str, Exercise]) -> Sequence[NewLink]:
    """Return the links that a tutor has chosen in a form. Raises NotYetError."""
    known = {} if offer.ticket.notices_url else {each.id: each for each in offer.assignments}
    there = [known[name] for name in dict.fromkeys(picked.assignments) if name in known]
    links = [
        NewLink(each.title, {it.exercise: it.points for it in each.exercises}, each.id)
        for each in there
    ]
    if picked.points:
        links += _of_exercises(picked, offer, catalogue)
    if not links:
        raise NotYetError(say("Choose at least one exercise."))
    if len(links) > 1 and not offer.ticket.takes_several:
        raise NotYetError(say("Your platform accepts one link here: choose one."))
    return links


def _of_exercises(
    picked: Picked, offer: Offer, catalogue: Mapping[str, Exercise]
) -> Sequence[NewLink]:
    points = picked.points or {}
    if any(name not in catalogue for name in points):
        raise NotYetError(say("One of these exercises is not there any more."))
    if picked.is_one and not picked.title:
        raise NotYetError(say("Enter a title."))
    new = _checked(picked, list(points.items()))
    opens, due = _date(new.opens, offer.zone), _date(new.due, offer.zone)
    if opens and due and opens > due:
        raise NotYetError(
            say("The due date is before the date from which on attempts are accepted.")
        )
    given = {each.exercise: each.points for each in new.exercises}
    if picked.is_one:
        return [NewLink(new.title, given, opens=opens, due=due, variants=picked.variants)]
    return [
        NewLink(
            catalogue[name].title, {name: worth}, opens=opens, due=due, variants=picked.variants
        )
        for name, worth in given.items()
    ]


def _checked(picked: Picked, points: Sequence[tuple[str, str]]) -> NewAssignment:
    fields: dict[str, Any] = {"id": "new", "title": picked.title or "Exercises"}
    fields["exercises"] = [{"exercise": name, "points": worth} for name, worth in points]
    fields |= {name: value for name in ("opens", "due") if (value := getattr(picked, name))}
    try:
        return NewAssignment.model_validate(fields)
    except ValidationError as error:
        if {"opens", "due"} & {each["loc"][0] for each in error.errors()}:
            raise NotYetError(say("Write dates as 2026-11-30 23:59.")) from error
        raise NotYetError(say("Points are numbers above 0, at most 10000.")) from error


def _date(written: datetime | None, zone: ZoneInfo) -> datetime | None:
    if written is None:
        return None
    try:
        return moment(written, zone)
    except CourseError as error:
        raise NotYetError(message_of(error)) from error


# --- Deep linking: the page with this form, and the page that sends links to the platform


def picker_page(
    offer: Offer,
    picked: Picked,
    ticket: str,
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return the page, without scripts, on which a tutor chooses exercises."""
    chosen = picked.points or {}
    return lti_page(
        "picker.html",
        assets,
        [],
        ["catalogue.css", "picker.css"],
        language=language,
        offer=offer,
        picked=picked,
        chosen=chosen,
        exercises=found(catalogue, language, picked.search, chosen),
        kinds_of=kinds_of,
        ticket=ticket,
    )


def return_page(address: str, response: str, assets: Assets, language: Language) -> bytes:
    """Return the page that sends the signed ``response`` to the platform."""
    values = {"address": address, "response": response}
    return lti_page("return.html", assets, ["send_form.js"], language=language, **values)


# --- Reports on files that a student has handed in at the learning platform
#
# The files are not stored here. For each view, the service reads them from the platform and grades
# them again.


class ReportPages:
    """Makes the pages that platforms open for handed-in files: a report, or the settings."""

    def __init__(
        self,
        assets: Assets,
        store: AttemptStore,
        secret: Secret,
        catalogue: Catalogue,
        feedback: FeedbackLevel,
        platform: PlatformFiles,
        threads: PlatformThreads,
    ) -> None:
        """``feedback`` is the highest feedback level for students."""
        self._assets, self._store, self._secret = assets, store, secret
        self._catalogue, self._feedback = catalogue, feedback
        self._platform, self._threads = platform, threads

    async def page(self, message: LaunchMessage, login: Login, language: Language) -> bytes:
        """Return the page that the platform's message asks for. Raises LtiError."""
        now = datetime.now(UTC)

        def found(connection: Connection) -> HandedFiles | None:
            use_login(connection, login, now)
            check_deployment(connection, message, now)
            return None if message.kind == SETTINGS else self._files(connection, message)

        files = await write(self._store, found)
        if files is None:
            return lti_page("file_settings.html", self._assets, [], language=language)
        contents = await self._contents(message.registration, files)
        graded = await asyncio.to_thread(
            graded_files,
            files,
            contents,
            self._catalogue,
            ceiling=self._feedback,
            for_students=message.role is not LtiRole.TUTOR,
            language=language,
        )
        if graded.submission is None:
            reasons = [each.reason for each in graded.failures.values()]
            raise LtiError("file-unreadable", reason=joined("; ", reasons))
        return page_of(graded.submission, language)

    def _files(self, connection: Connection, message: LaunchMessage) -> HandedFiles:
        submission = _id_in(message.claims, "submission")
        known = files_of(
            connection, message.registration.id, submission, _id_in(message.claims, "asset")
        )
        if known is None:
            raise LtiError("unknown-report")
        files, learner = known
        is_own = message.sub is not None and learner == pseudonym(
            message.registration.id, message.sub, self._secret
        )
        if not (message.role is LtiRole.TUTOR or (message.role is LtiRole.LEARNER and is_own)):
            raise LtiError("foreign-report")
        return files

    async def _contents(
        self, known: Registration, files: HandedFiles
    ) -> dict[str, bytes | NoFileError]:
        try:
            return await self._threads.run(
                known.id, lambda: self._platform.contents_of(known, files)
            )
        except ScoreError as error:
            raise LtiError("file-unreadable", reason=error) from error


def _id_in(claims: Mapping[str, Any], name: str) -> str:
    claim = claims.get(f"{LTI}{name}")
    found = claim.get("id") if isinstance(claim, dict) else None
    if not isinstance(found, str) or not 0 < len(found) <= 255:
        raise LtiError("bad-claim", claim=f"{LTI}{name}")
    return found
