"""Tables of short texts with aligned columns, for a terminal."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from rich.cells import cell_len
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.segment import Segment, Segments
from rich.table import Table
from rich.text import Text

_GAP: Final = 2

# A text and its style.
StyledText = tuple[str, str]


@dataclass(frozen=True, slots=True)
class AlignedColumn:
    """A column of a table: its heading, and the alignment of its cells."""

    heading: str
    justify: Literal["left", "center", "right"] = "left"

    def filled(self, text: str, width: int) -> str:
        """Return the text, padded with blanks."""
        missing = width - cell_len(text)
        before = {"left": 0, "center": missing // 2, "right": missing}[self.justify]
        return " " * before + text + " " * (missing - before)


@dataclass(frozen=True, slots=True)
class AlignedTable:
    """A table of short texts without lines; each row has a cell for each column."""

    columns: Sequence[AlignedColumn]
    rows: Sequence[Sequence[StyledText]]
    heading_style: str = "dim"

    def on(self, console: Console, width: int, indent: int) -> RenderableType:
        """Return the table to print, with ``indent`` blanks before each line.

        If the table is wider than ``width``, its columns become narrower.
        """
        texts = zip(*((text for text, _ in row) for row in self.rows), strict=True)
        widths = [
            max(map(cell_len, {column.heading, *cells}))
            for column, cells in zip(self.columns, texts, strict=True)
        ]
        if indent + sum(widths) + _GAP * (len(widths) - 1) > width:
            return Padding(self._narrowed(), (0, 0, 0, indent), expand=False)
        # Rich's own tables take ten times as long, because they measure each cell several times.
        headings = [(column.heading, self.heading_style) for column in self.columns]
        segments = []
        for line, gap_style in ((headings, self.heading_style), *((row, "") for row in self.rows)):
            gap = Segment(" " * _GAP, console.get_style(gap_style))
            segments.append(Segment(" " * indent))
            for column, cell_width, (text, style) in zip(self.columns, widths, line, strict=True):
                filled = column.filled(text, cell_width)
                segments += (Segment(filled, console.get_style(style)), gap)
            segments[-1] = Segment.line()
        return Segments(segments)

    def _narrowed(self) -> Table:
        table = Table(
            box=None,
            pad_edge=False,
            padding=(0, _GAP, 0, 0),
            header_style=self.heading_style,
        )
        for column in self.columns:
            table.add_column(
                column.heading, justify=column.justify, no_wrap=column.justify == "right"
            )
        for row in self.rows:
            table.add_row(*(Text(*cell) for cell in row))
        return table
