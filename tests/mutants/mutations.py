"""The small changes of a source file ("mutants"), in the order of the file.

Left alone are parts that cannot change an answer: annotations, docstrings, assertions (also those
of ``zip``), log lines, caches, and how dataclasses are stored.
"""

import ast
import copy
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

_COMPARED: Final[dict[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_COMPUTED: Final[dict[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
_NAMED: Final = {"min": "max", "max": "min", "all": "any", "any": "all"}
# Decorators and calls that decide how something is stored or found, not what is answered.
_STORED: Final = {
    "dataclass", "field", "lru_cache", "cached_property", "property", "staticmethod",
    "classmethod", "TypeVar", "ConfigDict",
}  # fmt: skip
# Functions whose arguments have no order. The columns of ``select`` and ``order_by`` have one.
_UNORDERED: Final = {
    "and_", "or_", "where", "group_by", "union_all", "min", "max", "minimum", "maximum",
}  # fmt: skip
# Of a join, the first two arguments are tables; their order counts in an outer join only.
_OUTER: Final = {"isouter", "full"}
# Floats smaller than this are tolerances: only another order of magnitude is another tolerance.
_SMALL: Final = 0.01

_Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
# A change of a syntax tree, and its way back.
_Change = tuple[Callable[[], object], Callable[[], object]]


@dataclass(frozen=True, slots=True)
class Mutant:
    """A changed statement: its function, and its text before and after the change.

    ``place`` says where the change is: in the body of a ``function``, in an ``assignment`` of the
    module, or elsewhere (``definition``).
    """

    line: int
    function: str
    before: str
    after: str
    place: str


def mutants(tree: ast.Module) -> Iterator[Mutant]:
    """Yield the mutants of a file; ``tree`` is changed until the next mutant is asked for."""
    seen = set[tuple[int, str, str]]()
    for spot in _spots(tree):
        before = _head(spot.statement)
        for change, back in _changes(spot):
            change()
            try:
                after = _head(spot.current())
                # Two changes may have the same result.
                found = spot.statement.lineno, before, after
                if before != after and found not in seen:
                    seen.add(found)
                    line = getattr(spot.node, "lineno", spot.statement.lineno)
                    ast.fix_missing_locations(tree)
                    yield Mutant(line, spot.function, before, after, spot.place)
            finally:
                back()


@dataclass(frozen=True, slots=True)
class _Spot:
    # A node with its statement. The node is in the field ``field`` of ``parent``, as the element
    # ``index`` if the field is a list. ``place`` is that of ``Mutant``.
    node: ast.AST
    parent: ast.AST
    field: str
    index: int
    statement: ast.stmt
    function: str
    place: str

    def put(self, new: ast.AST) -> None:
        """Put another node in the place of the node."""
        siblings = getattr(self.parent, self.field)
        if isinstance(siblings, list):
            siblings[self.index] = new
        else:
            setattr(self.parent, self.field, new)

    def current(self) -> ast.stmt:
        """Return the statement, or what was put in its place."""
        if self.node is not self.statement:
            return self.statement
        new: ast.stmt = getattr(self.parent, self.field)[self.index]
        return new


# Fields that are no code that runs.
_NOT_RUN: Final = {"annotation", "returns", "type_comment", "type_params"}
# Fields that run when a function or class is defined.
_DEFINING: Final = {"decorator_list", "defaults", "kw_defaults", "bases"}


def _spots(tree: ast.Module) -> Iterator[_Spot]:
    yield from _inside(tree, None, (), "definition")


def _inside(
    node: ast.AST, statement: ast.stmt | None, names: tuple[str, ...], place: str
) -> Iterator[_Spot]:
    for name, i, child in _children(node):
        own = child if isinstance(child, ast.stmt) else statement
        is_named = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        called = (*names, child.name) if is_named else names  # type: ignore[attr-defined]
        where = _place(node, name, child, place)
        if own is not None:
            yield _Spot(child, node, name, i, own, ".".join(called), where)
        yield from _inside(child, own, called, where)


def _children(node: ast.AST) -> Iterator[tuple[str, int, ast.AST]]:
    for name, value in ast.iter_fields(node):
        if name in _NOT_RUN:
            continue
        for i, child in enumerate(value if isinstance(value, list) else [value]):
            is_code = isinstance(child, ast.AST) and not _is_left_alone(child)
            if is_code and not (name == "decorator_list" and _called(child) in _STORED):
                yield name, i, child


def _place(node: ast.AST, name: str, child: ast.AST, place: str) -> str:
    # The ``place`` of ``Mutant`` for a child in the field ``name`` of a node at ``place``.
    if name in _DEFINING:
        return "function" if place == "function" else "definition"
    if isinstance(node, _Function) and name == "body":
        return "function"
    if isinstance(node, ast.Module) and isinstance(child, ast.Assign | ast.AnnAssign):
        return "assignment"
    return "definition" if isinstance(node, ast.Module | ast.ClassDef) else place


def _is_left_alone(node: ast.AST) -> bool:
    match node:
        case ast.Expr(value=ast.Constant()) | ast.Assert() | ast.Import() | ast.ImportFrom():
            return True
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="_log")))):
            return True
        case ast.Call():
            return _called(node) in _STORED
        case ast.keyword(arg="strict"):
            return True
    return False


def _called(node: ast.AST) -> str:
    match node:
        case ast.Call(func=function):
            return _called(function)
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


def _changes(spot: _Spot) -> Iterator[_Change]:
    node = spot.node
    for new in (*_other_values(node), *_other_statements(node)):
        yield partial(spot.put, new), partial(spot.put, node)
    match node:
        case ast.Compare():
            yield from (_swapped(node.ops, i) for i in range(len(node.ops)))
        case ast.BinOp() | ast.AugAssign() if type(node.op) in _COMPUTED:
            yield _set(node, "op", _COMPUTED[type(node.op)]())
        case ast.If() | ast.While() | ast.IfExp():
            yield _set(node, "test", ast.UnaryOp(ast.Not(), node.test))
        case ast.comprehension(ifs=ifs):
            for i, test in enumerate(ifs):
                yield _set_item(ifs, i, ast.UnaryOp(ast.Not(), test))
                yield _set_item(ifs, i, ast.Constant(True))
        case ast.Call():
            yield from _calls(node)
        case ast.Name(id=name, ctx=ast.Load()) if name in _NAMED:
            yield _set(node, "id", _NAMED[name])
    yield from _removals(node)


def _removals(node: ast.AST) -> Iterator[_Change]:
    match node:
        case ast.Match(cases=cases) if len(cases) > 1:
            yield from (_without(cases, i) for i in range(len(cases)))
        case ast.FunctionDef(decorator_list=found) | ast.AsyncFunctionDef(decorator_list=found):
            kept = [i for i, each in enumerate(found) if _called(each) not in _STORED]
            yield from (_without(found, i) for i in kept)


def _calls(node: ast.Call) -> Iterator[_Change]:
    if _is_ordered(node) and not any(isinstance(each, ast.Starred) for each in node.args[:2]):
        first, second, *rest = node.args
        yield _set(node, "args", [second, first, *rest])
    for i, each in enumerate(node.keywords):
        if each.arg == "strict" and _called(node) == "zip":
            continue  # like an assertion
        yield _set(node, "keywords", [*node.keywords[:i], *node.keywords[i + 1 :]])


def _is_ordered(node: ast.Call) -> bool:
    # True if the first two arguments cannot change places.
    name = _called(node)
    if name == "join_from" and not any(each.arg in _OUTER for each in node.keywords):
        return False
    return len(node.args) > 1 and name not in _UNORDERED


def _other_values(node: ast.AST) -> Iterator[ast.AST]:
    match node:
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield from (ast.Constant(value + 1), ast.Constant(value - 1))
        case ast.Constant(value=float(value)):
            factor = 10.0 if value < _SMALL else 2.0
            yield from (ast.Constant(value * factor), ast.Constant(value / factor))
        case ast.BoolOp(op=op, values=values):
            yield ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
            for i in range(len(values)):
                rest = [*values[:i], *values[i + 1 :]]
                yield rest[0] if len(rest) == 1 else ast.BoolOp(op, rest)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            if not isinstance(operand, ast.Constant):
                yield operand


def _other_statements(node: ast.AST) -> Iterator[ast.AST]:
    match node:
        case ast.Return(value=ast.Constant() | None):
            pass
        case ast.Return(value=ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not())):
            yield from (ast.Return(ast.Constant(each)) for each in (True, False))
        case ast.Return():
            yield ast.Return(ast.Constant(None))
        case ast.Expr(value=ast.Call() | ast.Await()) | ast.AugAssign() | ast.Raise():
            yield ast.Pass()
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]) | ast.Delete():
            yield ast.Pass()
        case ast.Break():
            yield ast.Continue()
        case ast.Continue():
            yield ast.Break()


def _set(node: ast.AST, name: str, new: Any) -> _Change:
    old = getattr(node, name)
    return (lambda: setattr(node, name, new)), (lambda: setattr(node, name, old))


def _set_item(nodes: list[Any], i: int, new: Any) -> _Change:
    old = nodes[i]
    return (lambda: nodes.__setitem__(i, new)), (lambda: nodes.__setitem__(i, old))


def _without(nodes: list[Any], i: int) -> _Change:
    old = nodes[i]
    return (lambda: nodes.pop(i)), (lambda: nodes.insert(i, old))


def _swapped(operators: list[ast.cmpop], i: int) -> _Change:
    return _set_item(operators, i, _COMPARED[type(operators[i])]())


def _head(statement: ast.stmt) -> str:
    # The text of a statement; of one with a body, only what is before the body.
    match statement:
        case ast.Match(cases=cases):
            patterns = " | ".join(ast.unparse(case.pattern) for case in cases)
            return f"match {ast.unparse(statement.subject)}: {patterns}"
        case ast.Try() | ast.TryStar():
            return "try"
    shown = copy.copy(statement)
    for name in ("body", "orelse"):
        if getattr(shown, name, None):
            setattr(shown, name, [])
    if isinstance(shown, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        shown.body = [ast.Pass()]
    text = ast.unparse(ast.fix_missing_locations(shown))
    return " ".join(text.split()).removesuffix(" pass")
