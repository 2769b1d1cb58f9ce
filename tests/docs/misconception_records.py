"""Write lists of the codes of misconceptions into pages of docs/.

Run ``python -m tests.docs.misconception_records``.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from textwrap import wrap
from typing import Final

from dh_grader.grading.misconception import Example, Record, all_records

from tests.docs.sentences import code_span, shown
from tests.grading.diagnosis.traces import trace_of

# The lists are written between comments:
#
#     <!-- records: WrongPosition -->
#     <!-- end -->
#
# A comment names the kinds of cases whose codes are listed: `records` lists the codes in a table
# with meanings and examples, `codes` lists the codes in a line.

DOCS: Final = Path(__file__).parents[2] / "docs"
PAGES: Final = tuple(DOCS / name for name in ("messages.md", "answer-kinds.md"))
_MARKED: Final = re.compile(r"(<!-- (records|codes): ([\w, ]+) -->\n).*?(<!-- end -->)", re.DOTALL)
_HEADING: Final = re.compile(r"^##+ (.+)$", re.MULTILINE)
# A longer answer is only on the page of sentences.
_LONGEST: Final = 90


def kinds_in(page: str) -> Iterator[tuple[str, str]]:
    for found in _MARKED.finditer(page):
        if found[2] == "records":
            section = _HEADING.findall(page, 0, found.start())[-1]
            yield from ((name, section) for name in found[3].split(", "))


def records_in(names: list[str]) -> list[Record]:
    kinds = {base for each in all_records() for base in each.of.__mro__}
    known = {kind.__name__: kind for kind in {record.of for record in all_records()} | kinds}
    bases = [base for name in names for base in known[name].__mro__]
    found = [record for record in all_records() if record.codes and record.of in bases]
    return sorted(found, key=lambda each: (bases.index(each.of), each.rank, each.name))


def written(page: str) -> str:
    """Return the page with the current lists of codes."""
    return _MARKED.sub(lambda found: f"{found[1]}{_LISTS[found[2]](_names(found))}{found[4]}", page)


def _names(found: re.Match[str]) -> list[str]:
    return found[3].split(", ")


def _table(names: list[str]) -> str:
    records = records_in(names)
    lines = ["", "| Code | What it means | For example |", "|---|---|---|"]
    for code in dict.fromkeys(code for record in records for code in record.codes):
        of_code = [record for record in records if code in record.codes]
        means = dict.fromkeys(each.meaning(code) for each in of_code)
        lines.append(f"| `{code}` | {'; '.join(means)} | {_example(of_code, code)} |")
    return "\n".join(lines) + "\n\n"


def _example(records: list[Record], code: str) -> str:
    for record in records:
        if record.example is not None and _causes(record.example, code, record.codes):
            exercise, part, answer, *unit = record.example
            place, text = shown_example(answer)
            if len(text) <= _LONGEST:
                said = f"{exercise}, {part}{', in degrees' if unit else ''}{place}"
                return f"{said}: {code_span(text)}"
    return ""


def _causes(example: Example, code: str, codes: tuple[str, ...]) -> bool:
    return len(codes) == 1 or code in trace_of(*example).codes


def shown_example(answer: object) -> tuple[str, str]:
    if isinstance(answer, dict) and all("/" in place for place in answer):
        if len(answer) == 1:
            [(place, text)] = answer.items()
            return f": {place}", str(text)
        return "", ", ".join(f"{place}: {text}" for place, text in answer.items())
    return "", shown(answer)


def _line(names: list[str]) -> str:
    codes = dict.fromkeys(code for record in records_in(names) for code in record.codes)
    text = ", ".join(f"`{code}`" for code in sorted(codes))
    return "\n".join(wrap(f"{text}.", width=120, break_long_words=False)) + "\n"


_LISTS: Final = {"records": _table, "codes": _line}


if __name__ == "__main__":
    for file in PAGES:
        file.write_text(written(file.read_text(encoding="utf-8")), encoding="utf-8")
