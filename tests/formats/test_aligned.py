"""An AlignedTable looks exactly like a table printed by Rich."""

import io

import pytest
from dh_grader.formats.terminal import AlignedColumn, AlignedTable
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

COLUMNS = (
    AlignedColumn("row"),
    AlignedColumn("alpha", "center"),
    AlignedColumn("q", "center"),
    AlignedColumn("pts", "right"),
)
ROWS = (
    (("1", ""), ("✓", "green"), ("?", "red"), ("1.5 / 2", "")),
    (("e", ""), ("", ""), ("中文", ""), ("2", "")),
)


def printed(what: object, width: int) -> str:
    file = io.StringIO()
    console = Console(file=file, width=width, force_terminal=True, legacy_windows=False)
    console.print(what, width=width)
    return file.getvalue()


@pytest.mark.parametrize("width", [10, 24, 29, 30, 80])
def test_a_table_looks_like_richs_own_table(width: int) -> None:
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for column in COLUMNS:
        no_wrap = column.justify == "right"
        table.add_column(column.heading, justify=column.justify, no_wrap=no_wrap)
    for row in ROWS:
        table.add_row(*(Text(*cell) for cell in row))
    expected = printed(Padding(table, (0, 0, 0, 2), expand=False), width)
    console = Console(width=width)
    assert printed(AlignedTable(COLUMNS, ROWS).on(console, width, 2), width) == expected
