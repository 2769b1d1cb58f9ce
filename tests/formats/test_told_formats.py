"""Test the report formats for students in a language other than English."""

import pytest

from tests.formats.submissions import ROWS, document, graded
from tests.translations.german import german

GERMAN = german({
    "{points} points": "{points} Punkte",
    "{points} points, {score}.": "{points} Punkte, {score}.",
    "{share} is needed to pass.": "Zum Bestehen braucht es {share}.",
    "{verdict}: the pass mark is {share}.": "{verdict}: zum Bestehen braucht es {share}.",
    "Counted with your own earlier answer.": "Mit Ihrer eigenen Antwort gerechnet.",
    "No file": "Keine Datei",
    "%(files)s for %(exercise)s, version %(version)s, graded by DH Grader %(grader)s":
        "%(files)s zu %(exercise)s, Fassung %(version)s, bewertet von DH Grader %(grader)s",
    "Not graded": "Nicht bewertet",
    "Not passed": "Nicht bestanden",
    "Nothing was handed in.": "Es wurde nichts abgegeben.",
    "Total for {exercise}: ": "Summe für {exercise}: ",
    "correct": "richtig",
    "incorrect": "falsch",
    "missing": "fehlt",
    "partial": "teils richtig",
    "passed": "bestanden",
    "points": "Punkte",
    "row": "Zeile",
    "row {row}": "Zeile {row}",
    "score": "Ergebnis",
    "submission": "Abgabe",
    "unreadable": "unlesbar",
    "… and {count} more": "… und {count} weitere",
})  # fmt: skip


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("text", ["Summe für planar-rrr: 0 / 16 Punkte, 0 %", "Nicht bestanden: zum Bestehen br"]),
        ("markdown", ["| Abgabe | Punkte | Ergebnis | bestanden |", ":** fehlt, 0 / 8 Punkte"]),
        ("html", ['<html lang="de">', ">Nicht bewertet<",
                  "</span>teils richtig</li>", "folder/anna.json zu planar-rrr, Fassung "]),
        ("gradescope", ["0 / 16 Punkte, 0 %."]),
        ("junit", ['message="fehlt, 0 / 8 Punkte"', ">0 / 8 Punkte\n"]),
        ("github", ["Zum Bestehen braucht es 80 %25.", "title=Nicht bestanden"]),
        ("classroom50", []),
    ],
)  # fmt: skip
def test_a_report_is_told_in_german(name: str, told: list[str]) -> None:
    found = document(name, graded({}), language=GERMAN)
    for each in (*told, "Es wurde nichts abgegeben."):
        assert each in found
    for english in ("Nothing was", " points", "assed:", "missing,"):
        assert english not in found


def test_a_table_is_told_in_german() -> None:
    submission = graded({"table": {"rows": [*ROWS[:3], {**ROWS[3], "a": "0"}]}})
    shown = document("html", submission, language=GERMAN)
    assert '<th scope="col">Zeile</th>' in shown
    assert '<th scope="col">Punkte</th>' in shown
    assert '<td class="incorrect"><div class="cell"><span class="sign" title="falsch">' in shown
    markdown = document("markdown", submission, language=GERMAN)
    assert "| Zeile | a | alpha | d | theta | Punkte |" in markdown
    text = document("text", submission, language=GERMAN)
    assert "✓ richtig   ~ teils richtig" in text or "✓ richtig   ✗ falsch" in text
