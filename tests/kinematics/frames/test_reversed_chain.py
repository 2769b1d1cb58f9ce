"""The product of a reversed chain of transforms is the inverse."""

from collections.abc import Sequence

import numpy as np
from dh_grader.kinematics import Numbers, compound, inverse, standard_link, z_links
from dh_grader.kinematics.frame_choice import (
    RowConstants,
    Target,
    TargetKind,
    match_tables,
    nearest_table,
    reversed_cells,
    reversed_rows,
    reversed_targets,
)

Rows = Sequence[tuple[float, float, float, float]]

SAMPLES = 3
PI = np.pi
# Rows (a, α, d, θ) from base to tool: two parallel axes, a perpendicular third one, and a tool.
REFERENCE: Rows = [(0, 0, 0, 0), (0.5, 0, 0.2, 0), (0.4, PI / 2, 0, 0), (0.1, 0, 0.3, 0)]
KINDS = [TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.TOOL]


def cells_of(table: Rows) -> Numbers:
    return np.repeat(np.array(table, dtype=np.float64)[..., None], SAMPLES, axis=-1)


def rows_of(table: Rows) -> list[RowConstants]:
    first = np.array([False, False, True, True])
    return [
        RowConstants(
            cells,
            ~(first & (i == 0)),
            np.zeros(4, np.bool_),
            first & (i == 0),
            np.zeros(4),
            3 if i else None,
            1 if i else 0,
        )
        for i, cells in enumerate(cells_of(table))
    ]


TARGETS = [
    Target(kind, standard_link(*row)) for kind, row in zip(KINDS, cells_of(REFERENCE), strict=True)
]
OFFSETS = z_links(cells_of(REFERENCE)[1:])


def seen_from_tool(table: Rows) -> tuple[float, Numbers]:
    targets = reversed_targets(TARGETS, OFFSETS)
    match = nearest_table(reversed_rows(rows_of(table)), targets, 0.5)
    return match.cost, -reversed_cells(match.rows)


def test_the_reversed_rows_give_the_inverse_product() -> None:
    cells = cells_of(REFERENCE)
    backwards = np.array([row.written for row in reversed_rows(rows_of(REFERENCE))])
    product = compound(standard_link(*np.moveaxis(backwards, 1, 0)))
    np.testing.assert_allclose(
        product, inverse(compound(standard_link(*np.moveaxis(cells, 1, 0)))), atol=1e-12
    )
    np.testing.assert_array_equal(-reversed_cells(backwards), cells)


def test_the_reference_is_valid_from_its_tool() -> None:
    backwards = np.array([row.written for row in reversed_rows(rows_of(REFERENCE))])
    targets = reversed_targets(TARGETS, OFFSETS)
    valid, poses = match_tables(backwards[None], np.array([[0, 1, 1, 1]]), targets, 0.5)
    assert valid[0]
    np.testing.assert_allclose(poses[:, 0] - np.eye(4), 0, atol=1e-12)


def test_another_base_is_valid_from_the_tool() -> None:
    cost, _ = seen_from_tool([(0, 0, 0, 0), (0.5, 0, 0.9, 1.1), *REFERENCE[2:]])
    assert cost < 1


def test_a_wrong_length_is_the_only_wrong_cell_from_the_tool() -> None:
    cost, rows = seen_from_tool([*REFERENCE[:2], (0.7, PI / 2, 0, 0), REFERENCE[3]])
    assert 1 <= cost < 2
    error = rows - cells_of(REFERENCE)
    error[:, [1, 3]] -= 2 * PI * np.round(error[:, [1, 3]] / (2 * PI))
    np.testing.assert_allclose(error, 0, atol=1e-12)
