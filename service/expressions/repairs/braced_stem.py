r"""A letter in braces, followed by its index: {\theta}_1, {c}_{12}."""

import re

from service.expressions.characters import greek, latex_commands
from service.expressions.characters.unicode import SUBSCRIPTS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

_LETTER = rf"\\?[A-Za-z]+|[{greek.CLASS}{''.join(greek.VARIANTS)}]"
_STEM = rf"{_LETTER}|\\(?:{'|'.join(sorted(latex_commands.STYLES))})\s*\{{\s*(?:{_LETTER})\s*\}}"
_INDEX = rf"(?:_(?:\{{[^{{}}]*\}}|[A-Za-z0-9]+)|[{''.join(SUBSCRIPTS)}]+|[0-9]+)"
_BRACED = regex(rf"\{{\s*({_STEM})\s*\}}(\s*{_INDEX})")
_WITHOUT_ARGUMENT = {*latex_commands.FUNCTIONS, *latex_commands.PLAIN, *latex_commands.SPACES}
# After these, a brace encloses an index, a power or the argument of a command.
_TAKEN = regex(r"(?:[_^]|\\([A-Za-z]+))\s*$")


@for_causes("name")
def repair_braced_stem(failure: Failure) -> Repair:
    """Suggest the name without braces, if this is readable."""
    source, (start, end) = failure.source, failure.span
    for match in _BRACED.finditer(source):
        if not (match.start(1) <= start and end <= match.end(1)) or _is_taken(source, match):
            continue
        name = f"{match[1]}{match[2].lstrip()}"
        # Without a blank, the name would merge with a letter or a command before it.
        glued = source[: match.start()][-1:].isalnum() and name[0].isalpha()
        joined = failure.replaced(f" {name}" if glued else name, match.span())
        repaired = failure.repaired(joined)
        if repaired is None:
            return None
        message = say("Write the name and its index without the braces: {name}.", name=quoted(name))
        return error(failure, "braced_stem", message, repaired, match.span())
    return None


def _is_taken(source: str, match: re.Match[str]) -> bool:
    before = _TAKEN.search(source[: match.start()])
    return before is not None and before[1] not in _WITHOUT_ARGUMENT
