"""The grammar's LALR table, made by lark, and the loop that runs it.

lark reads the grammar and works out the table; its own loop hashes a rule object at each
reduction and wraps each token in a string, which together cost several times the parse. This
loop takes the same table with the reductions looked up beforehand, and without those that build
nothing: a name alone would be reduced seven times before it is a sum.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import files
from typing import Any, Final, NamedTuple

from lark import Lark
from lark.lexer import Lexer
from lark.parsers.lalr_analysis import Shift

# A token: its terminal, the value that the builders see, its [start, end) in the text as typed.
Token = tuple[str, Any, int, int]
# A rule to reduce by: how many values it takes, what is built of them, the rule's own name.
Reduction = tuple[int, Callable[..., Any], str]
# A state is what it leads to: for each symbol that can be pushed on it, what is to be done by the
# terminal that comes next. Either a rule is reduced by, or the terminal is pushed on a state.
State = dict[str, "Choice"]
Choice = dict[str, "Reduction | State"]

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
    """The LALR table of grammar.lark, whose rules are built by the methods of `builder`.

    `rules` are the names that these methods have. Raises KeyError where one is lacking.
    """

    def __init__(self, builder: type) -> None:
        grammar = files(__package__).joinpath("grammar.lark").read_text("utf-8")
        lark = Lark(grammar, parser="lalr", lexer=_NoLexer, start="start")
        table: Any = lark.parser.parser._parse_table
        rows: _Rows = {
            number: {str(name): _action(*action) for name, action in actions.items()}
            for number, actions in table.states.items()
        }
        actions = (action for row in rows.values() for action in row.values())
        self.rules: Final = frozenset(
            action.builder for action in actions if isinstance(action, _Rule) and action.builder
        )
        builders = {name: vars(builder)[name] for name in self.rules}
        first, last = table.start_states["start"], table.end_states["start"]
        self._begin: Final = _worked_out(rows, first, last, builders)

    def parse(self, tokens: Sequence[Token], builder: object) -> Any:
        """Return what `builder` makes of `tokens`, which end in END.

        Its methods take the values of their rules, left to right. Raises UnexpectedTokenError.
        """
        # The state that each value was pushed on. The one above them all is settled only by the
        # terminal that comes next.
        states: list[State] = []
        values: list[Any] = []
        choice = self._begin
        for index, (terminal, value, _, _) in enumerate(tokens):
            action: Any = choice.get(terminal)
            while action.__class__ is tuple:
                length, build, origin = action
                if length == 3:
                    right, middle = values.pop(), values.pop()
                    values[-1] = build(builder, values[-1], middle, right)
                    del states[-2:]
                else:
                    values[-length:] = (build(builder, *values[-length:]),)
                    del states[len(states) + 1 - length :]
                choice = states[-1][origin]
                action = choice.get(terminal)
            if action is None:
                raise UnexpectedTokenError(index)
            if terminal == END:
                return values[0]
            states.append(action)
            values.append(value)
            choice = action[terminal]
        raise UnexpectedTokenError(len(tokens) - 1)


class _Rule(NamedTuple):
    """A rule to reduce by. One of a single symbol that has no builder only changes the state."""

    length: int
    builder: str | None
    name: str


# By state and symbol: the state to enter, or the rule to reduce by.
_Rows = dict[int, dict[str, int | _Rule]]


def _action(action: object, argument: Any) -> int | _Rule:
    if action is Shift:
        return int(argument)
    length, name = len(argument.expansion), str(argument.origin.name)
    passes = length == 1 and argument.alias is None
    return _Rule(length, None if passes else argument.alias or name, name)


def _worked_out(
    rows: _Rows, first: int, last: int, builders: Mapping[str, Callable[..., Any]]
) -> Choice:
    """Return what is to be done before the first token.

    What the rules without a builder come to depends on the state below and on the terminal that
    comes next, and on nothing else, so it is settled here.
    """
    states: dict[int, State] = {number: {} for number in rows}
    done: State = {}

    def action_on(below: int, top: int, terminal: str) -> Reduction | State | None:
        action = rows[top].get(terminal)
        while isinstance(action, _Rule):
            if action.builder is not None:
                return action.length, builders[action.builder], action.name
            top = rows[below][action.name]  # type: ignore[assignment]
            if top == last and terminal == END:
                return done
            action = rows[top].get(terminal)
        return None if action is None else states[top]

    def choice_on(below: int, top: int) -> Choice:
        found = {terminal: action_on(below, top, terminal) for terminal in rows[top]}
        return {terminal: action for terminal, action in found.items() if action is not None}

    for number, row in rows.items():
        pushed = {symbol: top for symbol, top in row.items() if isinstance(top, int)}
        states[number].update({symbol: choice_on(number, top) for symbol, top in pushed.items()})
    return dict.fromkeys(states[first], states[first])
