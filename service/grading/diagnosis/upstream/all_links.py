"""Slips in the table that change all link transforms of an answer."""

from collections.abc import Sequence

import numpy as np

from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.grading.diagnosis.tables.rows_and_columns import (
    TableRows,
    slips_of_rows,
)
from service.grading.diagnosis.upstream.length_slips import length_slips
from service.grading.diagnosis.upstream.slip import Change, change_cells
from service.grading.diagnosis.upstream.slip_search import SlipSearch
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers, slipped_tables
from service.grading.diagnosis.upstream.slipped_link import constants_and_motion
from service.grading.diagnosis.upstream.table_slips import lengths_of
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.numerics.comparison import nearly_equal
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.grading.part import Grading
from service.grading.reading.matrices.matrix import StudentMatrix
from service.kinematics.chain import Table, links
from service.kinematics.transforms import Matrices, Numbers

# Samples of each half that are enough to tell whole answers apart.
SUBSET = 4
# The work of explaining all link transforms, as the budget counts it.
LINKS_WORK = 6.0


def explain_links(
    matrices: Sequence[StudentMatrix],
    written: Matrices,
    right: Matrices,
    scale: Numbers,
    part: LinkTransformsSpec,
    grading: Grading,
) -> Finding | None:
    """Return the finding that explains all wrong link transforms at once, or None."""
    # written are the numbers of the matrices and right the correct numbers, (rows, SAMPLES, 4, 4)
    # each; scale is (4, 4). None also if the answer is judged by an earlier answer of the student.
    wrong = _wrong(written, right, scale)
    if grading.following or not wrong.any() or not grading.affords(LINKS_WORK):
        return None
    found = _explained(matrices, written, right, scale, part, grading)
    is_of_one = wrong.any(axis=(1, 2)).sum() == 1
    if is_of_one:
        # With one wrong link transform, only this slip can be one of all.
        return found if found and found.code == "other_convention" else None
    if found is None and part.frames == "free" and grading.affords(LINKS_WORK):
        # After such a slip, frames other than the student's may fit best: try the reference's.
        reference = _reference(part, grading)
        found = _explained(matrices, written, reference, scale, part, grading)
    return found


def _explained(
    matrices: Sequence[StudentMatrix],
    written: Matrices,
    right: Matrices,
    scale: Numbers,
    part: LinkTransformsSpec,
    grading: Grading,
) -> Finding | None:
    entries = [entry for matrix in matrices for row in matrix.entries for entry in row]
    wrong = _wrong(written, right, scale)
    search = SlipSearch(
        _slipped_links(right, part, grading),
        grading.samples,
        _at_subset(written),
        _at_subset(right),
        wrong,
        scale,
        name=grading.symbol_names(entries),
        unwritten=grading.unwritten(entries),
    )
    found = search.explanation(np.ones_like(wrong))
    return None if found is None else found.findings[0]


def _wrong(written: Matrices, right: Matrices, scale: Numbers) -> Mask:
    actual, expected = _at_subset(written), _at_subset(right)
    is_read = np.isfinite(actual).all(axis=-1)
    return np.asarray(is_read & ~nearly_equal(actual, expected, scale, False))


def _at_subset(transforms: Matrices) -> Numbers:
    return Samples.subset_of(np.moveaxis(transforms, 1, -1), SUBSET)


def _reference(part: LinkTransformsSpec, grading: Grading) -> Matrices:
    table = grading.exercise.robot.tables[part.convention]
    return links(table.values(grading.samples.values, SAMPLES), table.convention)


def _slipped_links(right: Matrices, part: LinkTransformsSpec, grading: Grading) -> SlippedAnswers:
    table, samples = grading.exercise.robot.tables[part.convention], grading.samples
    constants, motion = constants_and_motion(right, table.convention, table.joints, samples)
    slips = list(
        slips_of_rows(
            TableRows(
                constants[..., 0], table.joints, table.labels, table.convention, multiplied=False
            )
        )
    )
    in_its_frames = np.abs(right - _reference(part, grading)).max() < SAME_MOTION
    if in_its_frames:
        slips += [slip for slip in length_slips(*lengths_of(table)) if len(slip.symbols) == 2]

    def tables(changes: Sequence[Change], samples: Samples) -> Table:
        if in_its_frames:
            return slipped_tables(table, changes, samples.values, samples.count)
        fixed, moved = (
            cells if samples.count == SAMPLES else Samples.subset_of(cells, samples.count // 2)
            for cells in (constants, motion)
        )
        changed = np.repeat((fixed + moved)[:, :, None], len(changes), axis=2)
        change_cells(changes, changed, fixed + moved, fixed)
        return changed

    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        changed = tables(changes, samples)
        found = links(changed, table.convention)
        misread = [k for k, change in enumerate(changes) if change.misread]
        if misread:
            found[:, misread] = links(changed[:, :, misread], table.convention.other)
        return np.moveaxis(found, (1, 2), (0, -1))

    return SlippedAnswers(tuple(slips), at, by_symbols=False)
