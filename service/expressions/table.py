"""The grammar's LALR table, made by lark, and the loop that runs it.

lark reads the grammar and works out the table; its own loop hashes a rule object at each
reduction and wraps each token in a string, which together cost several times the parse. This
loop takes the same table with the reductions looked up beforehand.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import files
from typing import Any, Final

from lark import Lark
from lark.lexer import Lexer
from lark.parsers.lalr_analysis import Shift

# A token: its terminal, the value that the builders see, its [start, end) in the text as typed.
Token = tuple[str, Any, int, int]
# An action: the state to enter, or a rule to reduce by.
Reduction = tuple[int, str | None, str]

END: Final = "$END"


class UnexpectedTokenError(Exception):
    """The token at `index` cannot follow those before it."""

    def __init__(self, index: int) -> None:
        super().__init__(index)
        self.index = index


class _NoLexer(Lexer):
    """Stands where lark wants a lexer: the tokens come from tokens.py."""

    def __init__(self, lexer_conf: Any) -> None:
        pass

    def lex(self, lexer_state: Any, parser_state: Any) -> Iterator[Any]:
        raise NotImplementedError


class Table:
    """The LALR table of grammar.lark.

    A rule of one symbol without a name of its own builds nothing, so it is marked None and only
    changes the state.
    """

    def __init__(self) -> None:
        grammar = files(__package__).joinpath("grammar.lark").read_text("utf-8")
        lark = Lark(grammar, parser="lalr", lexer=_NoLexer, start="start")
        table: Any = lark.parser.parser._parse_table
        self.first: Final[int] = table.start_states["start"]
        self.last: Final[int] = table.end_states["start"]
        self.rows: Final[dict[int, dict[str, int | Reduction]]] = {
            state: {str(name): _action(*action) for name, action in actions.items()}
            for state, actions in table.states.items()
        }
        self.builders: Final = frozenset(
            action[1]
            for row in self.rows.values()
            for action in row.values()
            if isinstance(action, tuple) and action[1] is not None
        )

    def parse(self, tokens: Sequence[Token], builders: Mapping[str, Callable[..., Any]]) -> Any:
        """Return what the builders make of `tokens`, which end in END.

        A builder takes the values of its rule, left to right. Raises UnexpectedTokenError.
        """
        rows, last = self.rows, self.last
        states = [self.first]
        values: list[Any] = []
        for index, (terminal, value, _, _) in enumerate(tokens):
            action = rows[states[-1]].get(terminal)
            while action.__class__ is tuple:
                length, builder, origin = action
                if builder is None:
                    states.pop()
                else:
                    result = builders[builder](*values[-length:])
                    del states[-length:]
                    values[-length:] = (result,)
                state = rows[states[-1]][origin]
                states.append(state)  # type: ignore[arg-type]
                if state == last and terminal == END:
                    return values[0]
                action = rows[state].get(terminal)  # type: ignore[index]
            if action is None:
                raise UnexpectedTokenError(index)
            states.append(action)  # type: ignore[arg-type]
            values.append(value)
        raise UnexpectedTokenError(len(tokens) - 1)


def _action(action: object, argument: Any) -> int | Reduction:
    if action is Shift:
        return int(argument)
    length, name = len(argument.expansion), str(argument.origin.name)
    passes = length == 1 and argument.alias is None
    return length, None if passes else argument.alias or name, name
