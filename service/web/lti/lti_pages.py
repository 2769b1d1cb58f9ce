"""The pages that learning platforms open here, and their HTTP headers."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from service.api.http.lookup import Catalogue
from service.api.http.told_answer import language_headers
from service.catalogue import Exercise, in_language
from service.contract.courses import CourseAssignment
from service.translations import Language, say
from service.web.assets import Assets
from service.web.catalogue_words import words_of
from service.web.page_headers import FORM_HEADERS, policy
from service.web.pages import page

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.lti.linking import Landing
    from service.lti.logins import NewLogin

_FOLDER = "web/lti/templates"


def frame_headers(
    language: Language, origins: Iterable[str], *targets: str, style: str = ""
) -> dict[str, str]:
    """Return the HTTP headers of a page that only pages of ``origins`` may show in a frame.

    Forms in the page may be sent only to ``targets``. ``style`` is the hash of a style sheet inside
    the page.
    """
    # ``language`` is the language of the page. Without ``targets``, forms may be sent only to us.
    # The platform's window must stay the opener of the page, because that window may have the
    # platform's storage. With ``style``, the page may use no other style.
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


def login_page(login: "NewLogin", name: str, assets: Assets, language: Language) -> bytes:
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

    Without ``storage``, the page has only a button that opens the address ``window``.
    """
    # The address opens in a window of its own.
    # ``storage`` has the frame and the origin of the platform's storage, and the name of the stored
    # secret.
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
    landing: "Landing", token: str, catalogue: Catalogue, assets: Assets, language: Language
) -> bytes:
    """Return the page with exercises that a link on the learning platform opens.

    The page calls the service with ``token``.
    """
    # It is for a learner, a tutor's preview, or a guest.
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
    landing: "Landing",
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
    """Return the URL fragment of an assignment's only exercise, or ""."""
    # It is "" if the assignment has several exercises.
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
    """Return the page made from a template in this folder."""
    shown = {"is_framed": True, **values}
    styles = ["tutor.css", "records.css", *more_styles]
    path = f"{_FOLDER}/{template}"
    return page(path, assets, "../", ["page.js", *scripts], styles=styles, tutor=False, **shown)
