"""Update the translations with the sentences in the source.

``python -m tests.translations.catalogues`` updates all languages. The command writes sentences
without a translation to ``untranslated.json``. Fill in the texts there, and run the command again.
"""

# For one language, `--missing de sentences` prints the sentences that German lacks, as JSON;
# `--fill de sentences FILE` writes translations into the catalogue from such a JSON file.

import argparse
import json
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from io import BytesIO
from pathlib import Path
from string import Formatter
from typing import Any, Final

import typer
from babel.messages.catalog import Catalog
from babel.messages.extract import extract
from babel.messages.pofile import read_po, write_po
from dh_grader.cli import COMMANDS, commands_of, paragraphs, program, with_help
from dh_grader.translations import DOMAINS

ROOT: Final = Path(__file__).parents[2]
FOLDER: Final = ROOT / "service" / "dh_grader" / "translations"
CODES: Final = ("de", "es", "fr", "zh")
# The functions that mark a sentence: in Python, in templates of pages and in their scripts.
_KEYWORDS: Final[dict[str, dict[str, Any]]] = {
    "python": {"say": None, "template": None, "say_count": (1, 2)},
    "jinja2.ext:babel_extract": {"gettext": None, "_": None, "ngettext": (1, 2)},
    "javascript": {"worded": None, "wordedFor": (1, 2)},
}
# The sentences without a translation. Git ignores this file.
UNTRANSLATED: Final = ROOT / "untranslated.json"
# What a text quotes: a name or a piece of a formula.
_IN_PAGES: Final = re.compile(r"%\(\w+\)s")
_QUOTED: Final = re.compile(r"`[^`]+`")


@cache
def extracted(domain: str) -> Catalog:
    """Return the sentences of a domain (pages, command line or reports) in the source."""
    # Sentences in `dh_grader/web` belong to the domain of pages. Help texts and sentences in
    # `dh_grader/cli` belong to that of the command line, all other sentences to that of reports.
    found = Catalog(charset="utf-8", fuzzy=False)
    for file, method in _files(domain):
        with file.open("rb") as content:
            options = {"trimmed": "true"} if method.startswith("jinja2") else {}
            for _, message, comments, context in extract(
                method,
                content,
                keywords=_KEYWORDS[method],
                comment_tags=("Translators:",),
                options=options,
            ):
                name = file.relative_to(ROOT).as_posix()
                found.add(message, locations=[(name, 0)], auto_comments=comments, context=context)
    if domain == "commands":
        for text, name in help_texts():
            found.add(text, locations=[(name, 0)])
    return found


def help_texts() -> Iterator[tuple[str, str]]:
    file = "service/dh_grader/cli/__init__.py"
    yield from _help_texts(program, file)
    for name in COMMANDS:
        yield from _help_texts(commands_of(name), file)


def _help_texts(commands: typer.Typer, file: str) -> Iterator[tuple[str, str]]:
    for each in with_help(typer.main.get_command(commands)):
        called = getattr(getattr(each, "callback", None), "__wrapped__", None)
        if called is not None and called.__module__.startswith("dh_grader."):
            file = f"service/{called.__module__.replace('.', '/')}.py"
        for text in filter(None, paragraphs(getattr(each, "help", None) or "")):
            yield text, file


def _files(domain: str) -> Iterator[tuple[Path, str]]:
    for file in sorted((ROOT / "service" / "dh_grader").rglob("*.py")):
        if _domain(file) == domain:
            yield file, "python"
    for file in sorted((ROOT / "service" / "dh_grader").rglob("*.html")):
        if _domain(file) == domain:
            yield file, "jinja2.ext:babel_extract"
    if domain == "pages":
        for file in sorted((ROOT / "service" / "dh_grader" / "web" / "static").rglob("*.js")):
            if "vendor" not in file.parts:
                yield file, "javascript"


def _domain(file: Path) -> str:
    room = file.relative_to(ROOT / "service" / "dh_grader").parts[0]
    return {"web": "pages", "cli": "commands"}.get(room, "sentences")


def catalogue(code: str, domain: str) -> Catalog:
    """Return the catalogue of a language, or an empty one."""
    file = FOLDER / code / f"{domain}.po"
    if not file.is_file():
        return Catalog(locale=code, domain=domain, charset="utf-8", fuzzy=False)
    with file.open("rb") as content:
        return read_po(content, locale=code, domain=domain)


def updated(code: str, domain: str) -> Catalog:
    """Return the catalogue, updated with the sentences of the source."""
    old = catalogue(code, domain)
    new = Catalog(locale=code, domain=domain, charset="utf-8", fuzzy=False)
    for message in extracted(domain):
        if not message.id:
            continue
        known = old.get(message.id)
        new.add(
            message.id,
            known.string if known else None,
            locations=message.locations,
            auto_comments=message.auto_comments,
            user_comments=known.user_comments if known else (),
        )
    return new


def as_po(found: Catalog) -> bytes:
    """Return the text of a ``.po`` file."""
    out = BytesIO()
    # Babel's own comment names a holder of rights and a year.
    found.header_comment = "# Translations of DH Grader; the terms are those of glossary.md."
    write_po(
        out, found, width=0, omit_header=False, no_location=True, sort_output=True,
        ignore_obsolete=True,
    )  # fmt: skip
    kept = [
        line
        for line in out.getvalue().splitlines(keepends=True)
        if not line.startswith((b'"POT-Creation-Date', b'"PO-Revision-Date', b'"Generated-By'))
    ]
    return b"".join(kept)


def write(code: str, domain: str, found: Catalog) -> None:
    """Write the ``.po`` file of a catalogue."""
    (FOLDER / code).mkdir(exist_ok=True)
    (FOLDER / code / f"{domain}.po").write_bytes(as_po(found))


def faults(found: Catalog) -> Iterator[str]:
    """Yield the faults in the translations of a catalogue."""
    # A translation must have the same placeholders and the same texts between backticks as its
    # sentence. The translation must begin and end with a blank exactly where the sentence does.
    for message in found:
        sources = _texts(message.id)
        for text in filter(None, _texts(message.string) if message.id else ()):
            for what, of in (("places", _places), ("quotations", _quotations), ("ends", _ends)):
                if of(text) not in map(of, sources):
                    yield f"{what} of {text!r} differ from those of {sources[-1]!r}"


def _places(text: str) -> set[str]:
    # The text after the last place has no name. Those of templates of pages look like %(name)s.
    names = {name for _, name, _, _ in Formatter().parse(text) if name is not None}
    return names | set(_IN_PAGES.findall(text))


def _quotations(text: str) -> list[str]:
    return sorted(_QUOTED.findall(text))


def _ends(text: str) -> tuple[bool, bool]:
    return text[:1].isspace(), text[-1:].isspace()


def _missing(code: str, domain: str) -> list[dict[str, Any]]:
    plurals = catalogue(code, domain).num_plurals
    found = []
    for message in updated(code, domain):
        if message.id and not any(_texts(message.string)):
            many = isinstance(message.id, tuple)
            file = message.locations[0][0] if message.locations else ""
            text = [""] * plurals if many else ""
            found.append({"id": message.id, "text": text, "file": file})
    return found


def _texts(text: Any) -> tuple[str, ...]:
    return tuple(text) if isinstance(text, tuple | list) else (text or "",)


def untranslated() -> list[dict[str, Any]]:
    found: dict[object, dict[str, Any]] = {}
    for domain in DOMAINS:
        for code in CODES:
            for each in _missing(code, domain):
                entry = {"domain": domain, "file": each["file"], "id": each["id"]}
                found.setdefault((domain, each["id"]), entry)[code] = each["text"]
    return list(found.values())


def filled(found: Catalog, translations: Iterable[tuple[Any, Any]]) -> Catalog:
    for sentence, text in translations:
        message = found.get(tuple(sentence) if isinstance(sentence, list) else sentence)
        if message is None:
            sys.stderr.write(f"no such sentence: {sentence!r}\n")
        elif any(_texts(text)):
            message.string = tuple(text) if isinstance(text, list) else text
    sys.stderr.writelines(f"{fault}\n" for fault in faults(found))
    return found


def _fill(code: str, domain: str, file: Path) -> None:
    translations = [(each["id"], each["text"]) for each in json.loads(file.read_text("utf-8"))]
    write(code, domain, filled(updated(code, domain), translations))


def _update_all() -> None:
    known = json.loads(UNTRANSLATED.read_text("utf-8")) if UNTRANSLATED.is_file() else []
    for domain in DOMAINS:
        for code in CODES:
            entries = [each for each in known if each["domain"] == domain and code in each]
            found = filled(updated(code, domain), ((each["id"], each[code]) for each in entries))
            write(code, domain, found)
    if missing := untranslated():
        UNTRANSLATED.write_text(json.dumps(missing, ensure_ascii=False, indent=1) + "\n", "utf-8")
        sys.stderr.write(
            f"Sentences without a translation: {len(missing)}. "
            f"Write it in {UNTRANSLATED.name}, then run this again.\n"
        )
    else:
        UNTRANSLATED.unlink(missing_ok=True)


def _main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--missing", nargs=2, metavar=("LANGUAGE", "DOMAIN"))
    parser.add_argument("--fill", nargs=3, metavar=("LANGUAGE", "DOMAIN", "FILE"))
    given = parser.parse_args()
    if given.missing:
        json.dump(_missing(*given.missing), sys.stdout, ensure_ascii=False, indent=1)
    elif given.fill:
        _fill(given.fill[0], given.fill[1], Path(given.fill[2]))
    else:
        _update_all()


if __name__ == "__main__":
    _main()
