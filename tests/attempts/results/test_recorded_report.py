"""Recorded reports are translated into the language of each reader."""

import json
from collections.abc import Mapping
from dataclasses import replace

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import report_in
from dh_grader.grading import Correction, Feedback, Place, Report, Severity, Submission, grade
from dh_grader.store import recorded_report, sentence_in, shown_report
from dh_grader.translations import ENGLISH, Sentence, say, say_count

from tests.translations.german import german

GERMAN = german({
    "no answer": "keine Antwort",
    "Exchange {cells}.": "Vertausche {cells}.",
    "{first} and {last}": "{first} und {last}",
    "{count} rows in frame {{0}}": "{count} Zeilen im System {{0}}",
    "Frame {{0}} is given.": "System {{0}} ist gegeben.",
})  # fmt: skip


@pytest.fixture
def report(catalogue: Mapping[str, Exercise]) -> Report:
    graded = grade(catalogue["planar-rr"], Submission({}))
    first = graded.parts[0]
    exchange = say("Exchange {cells}.", cells=say("{first} and {last}", first="a", last="α"))
    texts = (
        exchange,
        say_count("one row", "{count} rows in frame {{0}}", count=2),
        say("Frame {{0}} is given."),
        "c_{12}",
    )
    messages = tuple(Feedback("code", Severity.ERROR, text) for text in texts)
    places = (Place("1", "a", Correction(exchange)), Place("1", "d", Correction("d1", "d_1")))
    placed = replace(messages[0], places=places)
    lost = tuple(replace(each, message=say("no answer")) for each in first.lost)
    return replace(graded, parts=(replace(first, feedback=(placed, *messages), lost=lost),))


def test_english_readers_get_the_report_byte_by_byte(report: Report) -> None:
    recorded = recorded_report(report)
    assert shown_report(recorded, ENGLISH) == rendered(report).decode()
    assert read_report(recorded.encode()) == report
    # Also if this version would write the report in another way.
    assert shown_report(recorded[:-1] + " }", ENGLISH) == rendered(report).decode()[:-1] + " }"


def test_a_report_without_sentences_is_recorded_as_it_is(report: Report) -> None:
    numbers_only = replace(report, parts=())
    recorded = recorded_report(numbers_only)
    assert recorded == rendered(numbers_only).decode()
    assert shown_report(recorded, GERMAN) == recorded


def test_another_reader_gets_another_language(report: Report) -> None:
    shown = shown_report(recorded_report(report), GERMAN)
    assert shown == rendered(report_in(report, GERMAN)).decode()
    part = json.loads(shown)["parts"][0]
    assert [each["message"] for each in part["feedback"]] == [
        "Vertausche a und α.",
        "Vertausche a und α.",
        "2 Zeilen im System {0}",
        "System {0} ist gegeben.",
        "c_{12}",
    ]
    assert part["lost"][0]["message"] == "keine Antwort"


def test_a_sentence_without_values_takes_no_room(report: Report) -> None:
    first = '["Exchange {cells}.",{"cells":["{first} and {last}",{"first":"a","last":"α"}]}]'
    second = '["one row",{"count":2},"{count} rows in frame {{0}}"]'
    third = '["Frame {{0}} is given.",{}]'
    start = f'{{"sentences":[{first},{second},{third}],'
    assert recorded_report(report) == start + rendered(report).decode()[1:]


def test_reports_of_earlier_versions_stay_in_english(report: Report) -> None:
    old = rendered(report).decode()
    assert shown_report(old, GERMAN) == old
    strange = '{"sentences":[],"parts":3}'
    assert shown_report(strange, GERMAN) == '{"parts":3}'


def test_one_sentence_of_a_recorded_report(report: Report) -> None:
    recorded = json.loads(recorded_report(report))
    found = sentence_in(recorded, "Exchange a and α.")
    assert getattr(found, "template", "") == "Exchange {cells}."
    assert type(sentence_in(recorded, "no answer")) is Sentence
    # Translations of the empty text and of braces are none of these texts.
    for text in ("", "c_{12}"):
        found = sentence_in(recorded, text)
        assert (type(found), found) == (str, text)
    assert type(sentence_in({}, "Exchange a and α.")) is str
