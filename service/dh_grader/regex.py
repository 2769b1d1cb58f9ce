"""Regular expressions that are compiled when they are first used.

Most of them are needed for few texts only, and compiling all of them takes a fifth of a short run.
"""

import re
from typing import Any, AnyStr, Final, cast

_ATTRIBUTES: Final = (
    "findall", "finditer", "flags", "fullmatch", "groupindex", "groups", "match", "scanner",
    "search", "split", "sub", "subn",
)  # fmt: skip


def regex(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """Return a regular expression that is compiled when one of its methods is first used.

    An invalid one raises ``re.error`` only then; a test compiles all.
    """
    return cast("re.Pattern[AnyStr]", _LateRegex(text, flags))


class _LateRegex:
    def __init__(self, text: str | bytes, flags: int) -> None:
        self.pattern = text
        self._flags = flags

    def __getattr__(self, name: str) -> Any:
        # Called only until the object has these attributes of its own.
        if name not in _ATTRIBUTES:
            raise AttributeError(name)
        compiled = re.compile(self.pattern, self._flags)
        vars(self).update((each, getattr(compiled, each)) for each in _ATTRIBUTES)
        return getattr(compiled, name)
