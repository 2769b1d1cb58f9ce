"""What went wrong: slips by their codes, texts that could not be read, and identical mistakes."""

from collections.abc import Mapping, Sequence
from typing import Final
from xml.etree.ElementTree import Element

from service.formats.class_page.overview import Overview
from service.formats.class_page.words import bar, folded, long_list, names, note, plural, section
from service.formats.shared.markup import Child, element
from service.formats.shared.messages import places_in_words
from service.formats.shared.part_results import LONGEST
from service.formats.shared.plain_text import code_pieces, shortened
from service.grading import Place
from service.statistics import CountedSlip, MistakeGroup

_MISTAKES_SHOWN: Final = 6


def misconceptions(overview: Overview) -> Element:
    """The section on slips in what was read."""
    content = [
        note(
            "Each counts once in a submission. The sentence is the one that most were told; the "
            "code stands for all with the same slip."
        )
    ]
    if untold := overview.statistics.untold:
        content.append(
            note(
                f"{plural(untold, 'report')} tell no slips, because of the feedback level. For "
                "your own eyes, grade again with --feedback full."
            )
        )
    content += _slips(overview, overview.statistics.slips.counted(), "No slip was found.")
    return section("misconceptions", "Misconceptions", *content)


def unreadable_texts(overview: Overview) -> Element:
    """The section on texts that could not be read."""
    intro = note(
        "No wrong answers: what cannot be read earns nothing yet, and takes nothing from the rest."
    )
    slips = overview.statistics.slips.counted(unreadable=True)
    listed = _slips(overview, slips, "Everything could be read.")
    return section("unreadable", "What could not be read", intro, *listed)


def _slips(overview: Overview, slips: Sequence[CountedSlip], none: str) -> list[Element]:
    if not slips:
        return [note(none)]
    titles = _part_titles(overview)
    return long_list([_slip(overview, slip, titles) for slip in slips])


def _slip(overview: Overview, slip: CountedSlip, titles: Mapping[tuple[str, str], str]) -> Element:
    sentence = shortened(slip.sentence, LONGEST)
    words: list[Child] = [
        element("code", piece) if is_code else piece for piece, is_code in code_pieces(sentence)
    ]
    where = ", ".join(f"{titles[part]} ({count:,})" for part, count in slip.parts.most_common())
    told = element("span", *words, class_="sentence")
    code = element("span", element("code", slip.slip_code), f" in {where}", class_="quiet")
    share = bar(slip.count / max(overview.statistics.scores.count, 1))
    lines = overview.listed(slip.submissions)
    return folded([_count(slip.count), element("span", told, code, share)], names(overview, lines))


def identical_mistakes(overview: Overview) -> Element:
    """The section on submissions with the same mistakes."""
    intro = note(
        "Submissions of which all wrong cells of a part are the same and hold the same entries as "
        "read. ",
        element("strong", "This is no proof of copying"),
        ": one common slip leads many to the same wrong entries. A long list of odd entries that "
        "two share may be worth a talk.",
    )
    groups = overview.statistics.identical.groups
    if not groups:
        return section("identical", "Identical mistakes", intro, note("No two are alike."))
    titles = _part_titles(overview)
    listed = long_list([_group(overview, group, titles) for group in groups])
    return section("identical", "Identical mistakes", intro, *listed)


def _group(
    overview: Overview, group: MistakeGroup, titles: Mapping[tuple[str, str], str]
) -> Element:
    cells = plural(len(group.mistakes), "wrong cell")
    heading = f"{titles[group.exercise, group.part]}, {cells}"
    shown = [
        element(
            "span",
            f"{places_in_words([Place(row, cell)])}: ",
            element("code", text),
            class_="mistake",
        )
        for row, cell, text in group.mistakes
    ]
    first, rest = shown[:_MISTAKES_SHOWN], shown[_MISTAKES_SHOWN:]
    if rest:
        first.append(element("span", f"… and {len(rest)} more", class_="quiet"))
    told = [element("span", heading, class_="sentence"), element("span", *first, class_="mistakes")]
    lines = overview.listed(group.submissions)
    return folded([_count(len(lines)), element("span", *told)], names(overview, lines))


def _count(count: int) -> Element:
    unseen = element("span", " submission" if count == 1 else " submissions", class_="unseen")
    return element("span", f"{count:,}", unseen, class_="number")


def _part_titles(overview: Overview) -> Mapping[tuple[str, str], str]:
    """The titles of parts, with that of the exercise where there are several."""
    has_several = len(overview.exercises) > 1
    return {
        (each.id, part.id): f"{each.title}: {part.title}" if has_several else part.title
        for each in overview.exercises.values()
        for part in each.parts
    }
