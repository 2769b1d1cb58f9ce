"""Find the codes of all messages of the program, by reading its source."""

# A code is the argument `code` of a class with a field or parameter of that name (Finding, Note,
# ExpressionError …), or of a function that passes it on to such a class. It must be a string
# constant, or a name to which only string constants are assigned. A code that is composed at run
# time cannot be found, and is refused.

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

CODE = "code"

Function = ast.FunctionDef | ast.AsyncFunctionDef
# Names and the values assigned to them, one pair for each assignment.
Given = list[tuple[str, ast.expr]]


@dataclass(frozen=True, slots=True)
class CodeUse:
    """A message code, and the file and line that use it."""

    code: str
    file: str
    line: int


class HiddenCodeError(Exception):
    """A message code that is not a string constant."""

    def __init__(self, file: str, value: ast.expr) -> None:
        super().__init__(f"{file}:{value.lineno}: not written out: {ast.unparse(value)}")


def sources(folder: Path) -> dict[str, str]:
    """Return the texts of all Python files in a folder, by path."""
    return {
        file.relative_to(folder).as_posix(): file.read_text(encoding="utf-8")
        for file in sorted(folder.rglob("*.py"))
    }


def codes_in(files: Mapping[str, str]) -> list[CodeUse]:
    """Return every use of a message code in these files."""
    trees = {file: ast.parse(text) for file, text in files.items()}
    nodes = {file: list(ast.walk(tree)) for file, tree in trees.items()}
    classes = _classes(chain.from_iterable(nodes.values()))
    passing_on = {file: dict(_functions(each)) for file, each in nodes.items()}
    functions = {name: at for found in passing_on.values() for name, at in found.items()}
    constants = [given for tree in trees.values() for given in _given(tree.body)]
    uses: list[CodeUse] = []
    for file, tree in trees.items():
        imported = _imported(nodes[file])
        passing = {name: functions[name] for name in imported & functions.keys()}
        carriers = {**classes, **passing, **passing_on[file]}
        known = [given for given in constants if given[0] in imported]
        known += _given(tree.body)
        for function, call in _calls(tree):
            value = _handed_over(call, carriers)
            if value is not None:
                found = _texts(value, function, known, file)
                uses += [CodeUse(text, file, call.lineno) for text in found]
    return uses


def _classes(nodes: Iterable[ast.AST]) -> dict[str, int]:
    carriers: dict[str, int] = {}
    heirs: list[tuple[str, set[str]]] = []
    for node in nodes:
        if not isinstance(node, ast.ClassDef):
            continue
        arguments = [
            statement.target.id
            for statement in node.body
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
        ]
        for statement in node.body:
            if isinstance(statement, Function) and statement.name == "__init__":
                arguments = _arguments(statement)
        if CODE in arguments:
            carriers[node.name] = arguments.index(CODE)
        elif not arguments:
            heirs.append(
                (node.name, {base.id for base in node.bases if isinstance(base, ast.Name)})
            )
    for _ in heirs:  # at most as many generations as subclasses
        carriers |= {
            name: carriers[base] for name, bases in heirs for base in bases & carriers.keys()
        }
    return carriers


def _functions(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, int]]:
    for node in nodes:
        if isinstance(node, Function) and node.name != "__init__" and CODE in _arguments(node):
            place = _arguments(node).index(CODE)
            # What can be handed over only by its name is seen in the call.
            if place < len(_arguments(node)) - len(node.args.kwonlyargs):
                yield node.name, place


def _arguments(function: Function) -> list[str]:
    given = function.args
    names = [each.arg for each in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    return names[1:] if names[:1] in (["self"], ["cls"]) else names


def _imported(nodes: Iterable[ast.AST]) -> set[str]:
    imports = (node for node in nodes if isinstance(node, ast.ImportFrom))
    return {alias.name for node in imports for alias in node.names}


def _given(nodes: Iterable[ast.AST]) -> Given:
    given: Given = []
    for node in nodes:
        if isinstance(node, ast.Assign):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
            given += [(name, node.value) for name in names]
        elif isinstance(node, ast.AnnAssign | ast.NamedExpr | ast.AugAssign) and node.value:
            given += [(node.target.id, node.value)] if isinstance(node.target, ast.Name) else []
    return given


def _calls(tree: ast.Module) -> Iterator[tuple[Function | None, ast.Call]]:
    waiting: list[tuple[ast.AST, Function | None]] = [(tree, None)]
    while waiting:
        node, around = waiting.pop()
        if isinstance(node, ast.Call):
            yield around, node
        inside = node if isinstance(node, Function) else around
        waiting += [(child, inside) for child in ast.iter_child_nodes(node)]


def _handed_over(call: ast.Call, carriers: Mapping[str, int]) -> ast.expr | None:
    for keyword in call.keywords:
        if keyword.arg == CODE:
            return keyword.value
    name = ""
    if isinstance(call.func, ast.Name):
        name = call.func.id
    elif isinstance(call.func, ast.Attribute):
        name = call.func.attr
    if name not in carriers:
        return None
    place, values = carriers[name], call.args
    unpacked = any(isinstance(value, ast.Starred) for value in values[: place + 1])
    return call if unpacked or place >= len(values) else values[place]


def _texts(value: ast.expr, function: Function | None, known: Given, file: str) -> list[str]:
    match value:
        case ast.Constant(str(text)):
            # A finding without a code gets that of its record.
            return [text] if text else []
        case ast.Tuple(elts=elements):
            return [text for each in elements for text in _texts(each, function, known, file)]
        case ast.Attribute(attr="code"):
            return []
        case ast.IfExp(body=one, orelse=other):
            branches = [_texts(branch, function, known, file) for branch in (one, other)]
            return [text for texts in branches for text in texts]
        case ast.Name(name) if function and name == CODE and CODE in _arguments(function):
            return []
        case ast.Name(name):
            inside = [] if function is None else _given(ast.walk(function))
            values = [given for each, given in inside if each == name]
            values = values or [given for each, given in known if each == name]
            if values:
                return [text for each in values for text in _texts(each, None, known, file)]
    raise HiddenCodeError(file, value)
