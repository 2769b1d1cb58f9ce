"""What all pages share, and the pages for everybody: exercises, help, sign-in and errors.

All pages share their headers, their static files and the template of the site. The pages for
tutors are in ``tutor.py`` and ``courses.py``, those in learning platforms in ``lti_pages.py``.
"""

import hashlib
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from graphlib import TopologicalSorter
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final, NamedTuple
from urllib.parse import parse_qs, quote, unquote

from fastapi import APIRouter, Request
from markupsafe import Markup
from starlette.responses import HTMLResponse, RedirectResponse, Response

from dh_grader.access import CredentialError, Keys, KeysBusyError, KeysUnreachableError, Scope
from dh_grader.api.document import SCRIPT, START, STYLE
from dh_grader.api.http import (
    NO_STORE,
    Catalogue,
    ProblemError,
    ProblemPage,
    keep_language,
    language_of,
    store_down,
)
from dh_grader.api.permissions import (
    PLAIN_COOKIE,
    SECURE_COOKIE,
    Access,
    access_problem,
    is_same_origin,
)
from dh_grader.catalogue import Exercise, by_level, in_language
from dh_grader.formats.texts import html, own_html
from dh_grader.kinematics import Convention
from dh_grader.regex import regex
from dh_grader.translations import ENGLISH, LANGUAGES, Language, say, template, told
from dh_grader.typeset import matrix, statement_html, typeset
from dh_grader.variants.robots import practice_id

# --- Pages as responses in the language of their readers, with headers that limit browsers


def policy(**more: str) -> str:
    """Return the Content-Security-Policy of a page; ``more`` replaces some of its directives."""
    # It allows nothing from other hosts, and no script or style inside the page. Scripts may turn
    # text into markup only with the Trusted Types policy of markup.js.
    directives = {
        "default_src": "'none'",
        "script_src": "'self'",
        "style_src": "'self'",
        "img_src": "'self' blob:",
        "connect_src": "'self'",
        "base_uri": "'none'",
        "form_action": "'self'",
        "frame_ancestors": "'self'",
        "require_trusted_types_for": "'script'",
        "trusted_types": "dh-grader",
        **more,
    }
    return "; ".join(f"{name.replace('_', '-')} {value}" for name, value in directives.items())


PAGE_HEADERS: Final = {
    "Content-Security-Policy": policy(),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Cache-Control": "no-cache",
}
# Swagger UI makes markup from text, which "require-trusted-types-for" would forbid.
REFERENCE_HEADERS: Final = {
    **PAGE_HEADERS,
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
}
# Browsers must not store what only a tutor may see.
PRIVATE_HEADERS: Final = {**PAGE_HEADERS, **NO_STORE}
# A page without a referrer would send its forms without an origin.
FORM_HEADERS: Final = {**PRIVATE_HEADERS, "Referrer-Policy": "same-origin"}


# The headers of a request that a page depends on. The menu depends on a tutor's session.
_VARY: Final = "Accept-Language, Cookie"


def page_answer(
    request: Request,
    content: bytes,
    headers: Mapping[str, str] = PAGE_HEADERS,
    status: HTTPStatus = HTTPStatus.OK,
) -> HTMLResponse:
    """Return a page as a response in the reader's language; store a newly chosen language."""
    answer = HTMLResponse(content, status, headers=dict(headers))
    answer.headers["Content-Language"] = language_of(request).tag
    answer.headers["Vary"] = _VARY
    keep_language(request, answer)
    return answer


# --- The static files, whose names contain a hash of their content
#
# The names are made when the service starts; there is no build step. In the source, a module
# imports another one by its path, such as ``"../shared/dom.js"``. Each language but English has one
# more file, the dictionary of the scripts.


FOLDER: Final = Path(__file__).parent / "static"
_MEDIA_TYPES: Final = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
# A file names another one by its path in quotes. A pattern that begins with plain characters is ten
# times as fast.
_NAMED: Final = regex(r'"(\.\.?/[\w./-]+\.(?:js|css|svg))"')
# A module may also import another one later.
_LATER: Final = ("import(", "import.meta.resolve(")
# The script that loads the dictionaries.
_WORDS: Final = "words.js"


@dataclass(frozen=True, slots=True)
class Asset:
    """A static file, with the ``name`` and the ``content`` that browsers get.

    ``needs`` has the plain names (those without a hash) of all files that it refers to, but not
    those of modules that a script imports only when it needs them.
    """

    name: str
    content: bytes
    media_type: str
    needs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Assets:
    """All static files, by their plain names: the names without a hash."""

    by_plain_name: Mapping[str, Asset]

    @property
    def by_name(self) -> dict[str, Asset]:
        """Return the files by the names under which they are served."""
        return {asset.name: asset for asset in self.by_plain_name.values()}

    def name(self, plain_name: str) -> str:
        """Return the name, with a hash, under which a file is served."""
        return self.by_plain_name[plain_name].name

    def modules(self, plain_name: str) -> list[str]:
        """Return the names of a module and of all modules that it imports, to preload them."""
        found: dict[str, None] = {}
        waiting = [plain_name]
        while waiting:
            name = waiting.pop()
            if name.endswith(".js") and name not in found:
                found[name] = None
                waiting += self.by_plain_name[name].needs
        return [self.name(name) for name in found]

    def words(self, language: Language) -> str | None:
        """Return the file name of a language's dictionary for scripts, or None if there is none."""
        found = self.by_plain_name.get(_dictionary_name(language))
        return None if found is None else found.name


def load_assets(folder: Path = FOLDER) -> Assets:
    """Return all static files in a folder and its subfolders.

    Raises LookupError for a reference to a missing file, or ValueError for equal file names.
    """
    found = [file for file in folder.rglob("*") if file.suffix in _MEDIA_TYPES]
    files = {file.name: file for file in found}
    if len(files) < len(found):
        raise ValueError(f"two static files have the same name: {sorted(map(str, found))}")
    texts = {name: file.read_text(encoding="utf-8") for name, file in files.items()}
    named = {name: list(_NAMED.finditer(text)) for name, text in texts.items()}
    targets = {name: [_target(files, name, match) for match in named[name]] for name in files}
    assets: dict[str, Asset] = {}
    if _WORDS in texts:
        languages = [each for each in LANGUAGES.values() if each.translation]
        sentences = sentences_in(texts.values())
        for each in languages:
            name = _dictionary_name(each)
            assets[name] = _asset(name, dictionary(each, sentences).encode())
        addresses = {each.code: f"./{_dictionary_name(each)}" for each in languages}
        texts[_WORDS] = with_dictionaries(texts[_WORDS], addresses)
    # The named files come first: a name is part of the content that is hashed.
    for name in TopologicalSorter(targets).static_order():
        content = _NAMED.sub(lambda match: f'"./{assets[_name(match)].name}"', texts[name]).encode()
        needs = tuple(
            target
            for target, match in zip(targets[name], named[name], strict=True)
            if not texts[name].endswith(_LATER, 0, match.start())
        )
        assets[name] = _asset(name, content, needs)
    return Assets(assets)


def _asset(name: str, content: bytes, needs: tuple[str, ...] = ()) -> Asset:
    stem, suffix = Path(name).stem, Path(name).suffix
    hashed = f"{stem}-{hashlib.sha256(content).hexdigest()[:12]}{suffix}"
    return Asset(hashed, content, _MEDIA_TYPES[suffix], needs)


def _dictionary_name(language: Language) -> str:
    return f"words-{language.code}.js"


def _name(match: re.Match[str]) -> str:
    return match[1].rpartition("/")[2]


def _target(files: Mapping[str, Path], name: str, match: re.Match[str]) -> str:
    # Return the plain name of the file to which a reference in the file ``name`` leads.
    path = Path(os.path.normpath(files[name].parent / match[1]))
    if files.get(path.name) != path:
        raise LookupError(f"the static file {name} names {path}, which does not exist")
    return path.name


# --- Translate the sentences in the pages' scripts: one dictionary for each language
#
# English needs none.


# A sentence in a script: the first argument of `worded`, or the first two of `wordedFor`.
_TEXT: Final = r"\s*(\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
_WORDED: Final = regex(rf"\bworded\({_TEXT}")
_COUNTED: Final = regex(rf"\bwordedFor\({_TEXT},{_TEXT}")
# The place in words.js for the names of the dictionaries.
_PLACE: Final = "const FILES = {};"


class ScriptSentences(NamedTuple):
    """The English sentences of scripts; ``counted`` has pairs of a singular and a plural."""

    plain: tuple[str, ...]
    counted: tuple[tuple[str, str], ...]


def sentences_in(scripts: Iterable[str]) -> ScriptSentences:
    """Return the English sentences in all scripts."""
    # A vendored library is larger than all own scripts and has none.
    own = [script for script in scripts if "worded" in script]
    plain = (_unquoted(match[1]) for script in own for match in _WORDED.finditer(script))
    counted = (
        (_unquoted(match[1]), _unquoted(match[2]))
        for script in own
        for match in _COUNTED.finditer(script)
    )
    return ScriptSentences(tuple(plain), tuple(counted))


def dictionary(language: Language, sentences: ScriptSentences) -> str:
    """Return the JavaScript file with a language's translations of the sentences in scripts."""
    words: dict[str, str] = {}
    counts: dict[str, tuple[str, str]] = {}
    translation = language.translation_of_scripts
    if translation is not None:
        for text in sentences.plain:
            if (told := translation.gettext(text)) != text:
                words[text] = told
        for one, many in sentences.counted:
            forms = (translation.ngettext(one, many, 1), translation.ngettext(one, many, 2))
            if forms != (one, many):
                counts[one] = forms
    found: dict[str, Any] = {"tag": language.tag, "words": words, "counts": counts}
    return f"export default {json.dumps(found, ensure_ascii=False, sort_keys=True)};\n"


def with_dictionaries(script: str, names: dict[str, str]) -> str:
    """Return words.js, the text ``script``, with the addresses of the dictionaries by language."""
    return script.replace(_PLACE, f"const FILES = {json.dumps(names)};")


def _unquoted(text: str) -> str:
    """Return the text of a string literal in JavaScript."""
    if text[0] == "'":
        text = '"' + text[1:-1].replace("\\'", "'").replace('"', '\\"') + '"'
    return str(json.loads(text))


# --- The pages of students as HTML, which can be read without scripts


# The entries of the menu: text, and address relative to the root.
_MENU: Final = (
    (say("Exercises"), ""),
    (say("Practice"), "practice"),
    (say("Free play"), "play"),
    (say("Help"), "help/expressions"),
)
_TUTORS_MENU: Final = (*_MENU, (say("For tutors"), "tutor"))
# The link transform of a row, in the standard and in the modified convention.
_TRANSFORMS: Final = (
    (
        "A_i = Rot_z(θ) Trans_z(d) Trans_x(a) Rot_x(α)",
        """cos(theta), -sin(theta)*cos(alpha), sin(theta)*sin(alpha), a*cos(theta)
        sin(theta), cos(theta)*cos(alpha), -cos(theta)*sin(alpha), a*sin(theta)
        0, sin(alpha), cos(alpha), d
        0, 0, 0, 1""",
    ),
    (
        "A_i = Rot_x(α) Trans_x(a) Rot_z(θ) Trans_z(d)",
        """cos(theta), -sin(theta), 0, a
        sin(theta)*cos(alpha), cos(theta)*cos(alpha), -sin(alpha), -d*sin(alpha)
        sin(theta)*sin(alpha), cos(theta)*sin(alpha), cos(alpha), d*cos(alpha)
        0, 0, 0, 1""",
    ),
)
_OF_A: Final = '<span class="maths">(<math><mi>a</mi></math>)</span>'


def catalogue_page(
    catalogue: Catalogue, assets: Assets, language: Language, *, tutor: bool = False
) -> bytes:
    """Return the page with the list of all exercises."""
    shown = [in_language(each, language) for each in catalogue.values()]
    return page(
        "web/templates/catalogue.html",
        assets,
        "",
        ["page.js", "catalogue.js"],
        styles=["catalogue.css"],
        language=language,
        tutor=tutor,
        groups=by_level(shown),
        kinds_of=kinds_of,
        # An English word finds an exercise in every language.
        words_of=lambda it: words_of(it, language, catalogue[it.id]),
    )


def exercise_page(
    exercise: Exercise,
    following: Exercise | None,
    assets: Assets,
    language: Language,
    *,
    tutor: bool = False,
) -> bytes:
    """Return the page of an exercise, with a link to the next exercise ``following``."""
    return page(
        "web/templates/exercise.html",
        assets,
        "../",
        ["page.js", "embed.js"],
        styles=["print.css"],
        language=language,
        tutor=tutor,
        exercise=in_language(exercise, language),
        next=following and in_language(following, language),
        is_generated=practice_id(exercise.id) is not None,
        markdown=_markdown,
    )


def play_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page of free play, which accepts the table of any robot."""
    return page(
        "web/templates/play.html",
        assets,
        "",
        ["page.js", "play.js"],
        language=language,
        tutor=tutor,
    )


def practice_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page for practice with generated robots, which a script loads one by one."""
    return page(
        "web/templates/practice.html",
        assets,
        "",
        ["page.js", "embed.js", "practice.js"],
        styles=["print.css"],
        language=language,
        tutor=tutor,
    )


def ten_minutes_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page "DH in ten minutes"."""
    return page(
        "web/templates/learn_dh.html",
        assets,
        "",
        ["page.js", "ten_minutes.js"],
        styles=["ten_minutes.css"],
        language=language,
        tutor=tutor,
        transforms=[
            # As a word of a sentence, "a" is no name.
            own_html(f"{typeset(moves, {'d'}).replace('(a)', _OF_A)} = {matrix(entries)}")
            for moves, entries in _TRANSFORMS
        ],
    )


def learner_page(assets: Assets, language: Language) -> bytes:
    """Return the page of a learner with a personal link; its script loads the assignments."""
    return page(
        "web/templates/learn.html",
        assets,
        "",
        ["page.js", "embed.js", "learner.js"],
        styles=["learner.css"],
        language=language,
        key="",
        place="",
    )


def reference_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page /docs, the reference of the HTTP interface."""
    return page(
        "web/templates/docs.html",
        assets,
        "",
        ["page.js"],
        styles=["docs.css"],
        language=language,
        tutor=tutor,
        swagger=[SCRIPT, START],
        swagger_style=STYLE,
    )


def page(
    template: str,
    assets: Assets,
    root: str,
    scripts: Iterable[str],
    *,
    styles: Iterable[str] = (),
    language: Language | None = None,
    tutor: bool = False,
    is_framed: bool = False,
    **values: object,
) -> bytes:
    """Return the page made from a template that extends ``site.html``.

    ``root`` is the relative address of the catalogue, and ``values`` are the template's variables.
    With ``is_framed``, the page has no menu.
    """
    # Other pages do not open in a frame. The menu has one more entry for a ``tutor``. A page
    # without a ``language`` is in English, and offers no other language.
    static = f"{root}static/"
    offers = language is not None and not is_framed and len(LANGUAGES) > 1
    modules = dict.fromkeys(name for script in scripts for name in assets.modules(script))
    words = assets.words(language) if language else None
    if words and assets.name("words.js") in modules:
        modules[words] = None
    return html(
        template,
        language=language or ENGLISH,
        languages=list(LANGUAGES.values()) if offers else [],
        asset=lambda name: f"{static}{assets.name(name)}",
        menu=_TUTORS_MENU if tutor else _MENU,
        modules=[f"{static}{name}" for name in modules],
        root=root,
        scripts=list(scripts),
        styles=list(styles),
        is_framed=is_framed,
        **values,
    )


def _markdown(text: str, exercise: Exercise) -> Markup:
    """Return the HTML of a text that the exercise's author has written in Markdown."""
    return own_html(statement_html(text, exercise.symbols))


# --- The words by which a search finds an exercise in the catalogue


_KIND_NAMES: Final = {
    "dh_table": say("DH table"),
    "dh_row": say("DH row"),
    "frames": say("placing frames"),
    "find_slip": say("finding the slip"),
    "link_transforms": say("link transforms"),
    "euler_angles": say("Euler angles"),
    "screw_axes": say("screw axes"),
    "matrix": say("matrix"),
    "position": say("position"),
    "rotation": say("rotation"),
    "transform": say("transform"),
    "vector": say("vector"),
}
# The words that lectures and books use.
_CONVENTIONS: Final = {
    Convention.STANDARD: "standard distal",
    Convention.MODIFIED: "modified proximal Craig",
}
_JOINTS: Final = {"R": "revolute rotary turning", "P": "prismatic linear sliding"}


def kinds_of(exercise: Exercise) -> Iterable[str]:
    """Return each kind of answer that an exercise asks for, such as a DH table."""
    return dict.fromkeys(_KIND_NAMES.get(part.kind, part.kind) for part in exercise.parts)


def words_of(
    exercise: Exercise, language: Language = ENGLISH, original: Exercise | None = None
) -> str:
    """Return all words of an exercise by which a search may find it.

    The words of the English ``original`` are included.
    """
    texts = [told(each, language.translation) for each in _texts(exercise)]
    if language.translation:
        texts += _texts(original or exercise)
    return " ".join(dict.fromkeys(" ".join(texts).split()))


def _texts(exercise: Exercise) -> Iterator[str]:
    yield from (exercise.id, exercise.title, exercise.summary, *exercise.keywords)
    yield from (_CONVENTIONS[convention] for convention in exercise.conventions)
    if joints := exercise.structure:
        letters = dict.fromkeys(joints)
        # A "6R" arm has six joints that turn. The search reads "6 dof" as "6dof".
        yield from (joints, f"{len(joints)}dof", *(_JOINTS[letter] for letter in letters))
        if len(letters) == 1:
            yield f"{len(joints)}{joints[0]}"
    yield from kinds_of(exercise)
    for part in exercise.parts:
        yield from (part.title, part.prompt)


# --- The help pages and their routes
#
# They need no scripts.


# The pages by their addresses, with their titles.
TOPICS: Final = {
    "expressions": say("What you may type"),
    "pasting": say("Paste a table or a matrix"),
    "points": say("How you earn points"),
}


def help_routes(assets: Assets, access: Access) -> APIRouter:
    """Return the routes of the help pages, one for each topic."""
    router = APIRouter()

    @router.get("/help")
    async def first(request: Request) -> Response:
        """Redirect to the first help page."""
        answer = RedirectResponse("help/expressions")
        keep_language(request, answer)
        return answer

    def add(topic: str) -> None:
        async def shown(request: Request) -> Response:
            tutor = access.shows_solutions(request)
            content = help_page(topic, assets, language_of(request), tutor=tutor)
            return page_answer(request, content)

        router.add_api_route(f"/help/{topic}", shown)

    for topic in TOPICS:
        add(topic)
    return router


def help_page(topic: str, assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the help page on one of the ``TOPICS``."""
    return page(
        f"web/templates/help/{topic}.html",
        assets,
        "../",
        ["page.js"],
        styles=["help.css"],
        language=language,
        tutor=tutor,
        topic=topic,
        topics=TOPICS,
    )


# --- The page on which tutors sign in with their key, and the routes to sign in and out


# A session ends after one working day; using it does not make it longer.
SESSION: Final = timedelta(hours=10)
HOME: Final = "/tutor"
# Paths of tutors' pages, as browsers send them.
_OURS: Final = regex(r"/tutor(?:[/?][A-Za-z0-9/?._~%&=+:@!$'()*,;-]*)?", re.ASCII)
_LONGEST: Final = 2000
_MOST_FIELDS: Final = 10


def sign_in_routes(assets: Assets, access: Access) -> APIRouter:
    """Return the routes to sign in and out."""
    router = APIRouter(prefix="/tutor", include_in_schema=False)

    def form(request: Request, following: str, message: str = "") -> Response:
        content = page(
            "web/templates/sign_in.html",
            assets,
            "../",
            ["page.js"],
            styles=["tutor.css", "records.css"],
            language=language_of(request),
            following=following,
            message=message,
        )
        status = HTTPStatus.FORBIDDEN if message else HTTPStatus.OK
        return page_answer(request, content, FORM_HEADERS, status)

    @router.get("/sign-in")
    async def ask(request: Request, following: str = HOME) -> Response:
        """Return the form on which a tutor enters a key."""
        return form(request, own_path(following))

    @router.post("/sign-in")
    async def begin(request: Request) -> Response:
        """Start a session, and open the page that the tutor wanted."""
        fields = await form_fields(request)
        following = own_path(fields.get("following", ""))
        if access.keys is None or not await access.keys.are_needed():
            return _see(following)
        if not is_same_origin(request):
            message = say("The form was sent by a page of another site. Send it again.")
            return form(request, following, message)
        until = datetime.now(UTC) + SESSION
        try:
            session = await _session(access.keys, fields.get("key", "").strip(), until)
        except CredentialError as error:
            return form(request, following, error.args[0] if error.args else str(error))
        answer = _see(following)
        set_session_cookie(answer, request, session)
        return answer

    @router.post("/sign-out")
    async def end(request: Request) -> Response:
        """End the tutor's session in this browser."""
        answer = _see(f"{HOME}/sign-in")
        if is_same_origin(request):
            set_session_cookie(answer, request, "")
        return answer

    return router


def sign_in_address(path: str, query: str) -> str:
    """Return the relative address of the sign-in form that leads back to a page."""
    wanted = f"{path}?{query}" if query else path
    return f"tutor/sign-in?following={quote(own_path(wanted), safe='')}"


def own_path(path: str) -> str:
    """Return the path if it leads to a tutor's page, otherwise the path of the home page."""
    is_ours = len(path) <= _LONGEST and _OURS.fullmatch(path) and ".." not in unquote(path)
    return path if is_ours else HOME


async def _session(keys: Keys, key: str, until: datetime) -> str:
    """Return a session token for the holder of a key. Raises CredentialError, ProblemError."""
    if not key:
        raise CredentialError(say("Enter a key."))
    try:
        caller = await keys.caller(key)
    except KeysUnreachableError as error:
        raise store_down(say("The key cannot be checked: the database does not answer.")) from error
    except KeysBusyError as error:
        raise access_problem("busy") from error
    if Scope.TUTOR not in caller.scopes or caller.learner is not None:
        raise CredentialError(say("This key is not a tutor's: it has not the scope tutor."))
    return keys.session(caller, until)


async def form_fields(request: Request, most: int = _MOST_FIELDS) -> dict[str, str]:
    """Return the fields of a form."""
    body = (await request.body()).decode(errors="replace")
    try:
        return {name: each[0] for name, each in parse_qs(body, max_num_fields=most).items()}
    except ValueError:
        return {}


def _see(path: str) -> Response:
    # Relative to /tutor/…, so that it works below the prefix of a proxy.
    return RedirectResponse(f"..{path}", HTTPStatus.SEE_OTHER, NO_STORE)


def set_session_cookie(answer: Response, request: Request, session: str) -> None:
    """Set the session cookie; without a session, remove the session cookies."""
    # The ``Origin`` header of the browser shows whether the browser uses HTTPS. A service behind a
    # proxy may not know that otherwise.
    origin = request.headers.get("origin", "")
    is_secure = origin.startswith("https:") or request.url.scheme == "https"
    age = int(SESSION.total_seconds()) if session else 0
    for name in (SECURE_COOKIE, PLAIN_COOKIE):
        if not session or (name == SECURE_COOKIE) is is_secure:
            secure = name == SECURE_COOKIE
            answer.set_cookie(name, session, age, secure=secure, httponly=True, samesite="lax")


# --- The pages that explain an error, with advice, in place of the requested page


# The advice to readers without a tutor's key, by the names of problems.
_FOR_TUTORS: Final[Mapping[str, str]] = {
    "scope-missing": template("{detail} This page needs a tutor's key."),
    "solutions-off": template(
        "Create a tutor's key, and sign in with it. If DH_GRADER_SOLUTIONS is false, "
        "no key opens this page."
    ),
    "attempts-not-shown": template(
        "Create a tutor's key, and sign in with it. If DH_GRADER_READ_ATTEMPTS "
        "is false, no key opens this page."
    ),
}


def problem_page(assets: Assets) -> ProblemPage:
    """Return a function that makes an HTML error page from a problem.

    The function returns None if the request did not ask for a page.
    """

    def made(request: Request, problem: ProblemError) -> Response | None:
        path = request.url.path.removeprefix(request.scope.get("root_path", ""))
        accepted = request.headers.get("accept", "")
        if request.method != "GET" or path.startswith("/v1/") or "text/html" not in accepted:
            return None
        root = "../" * (path.count("/") - 1)
        if problem.status is HTTPStatus.UNAUTHORIZED:
            asking = f"{root}{sign_in_address(path, request.url.query)}"
            return RedirectResponse(
                asking, HTTPStatus.SEE_OTHER, {**PRIVATE_HEADERS, "Vary": "Accept, Cookie"}
            )
        language = language_of(request)
        response = problem.answer(_content(problem, assets, root, language))
        vary = "Accept, Accept-Language, Cookie"
        response.headers.update({**PRIVATE_HEADERS, "Content-Language": language.tag, "Vary": vary})
        keep_language(request, response)
        return response

    return made


def _content(problem: ProblemError, assets: Assets, root: str, language: Language) -> bytes:
    name, is_missing = problem.name, problem.status is HTTPStatus.NOT_FOUND
    if name in _FOR_TUTORS:
        heading: str = say("This page is for tutors")
    elif is_missing and not name:
        heading = say("Page not found")
    else:
        heading = problem.title or problem.status.phrase
    advice = _FOR_TUTORS.get(name)
    return page(
        "web/templates/problem.html",
        assets,
        root,
        ["page.js"],
        styles=["tutor.css", "records.css"],
        language=language,
        heading=heading,
        advice=say(advice, detail=problem.detail) if advice else "",
        links_to_exercises=name == "other-exercise",
        needs_database=name == "attempts-not-recorded",
        links_to_catalogue=is_missing,
        detail=problem.detail,
    )
