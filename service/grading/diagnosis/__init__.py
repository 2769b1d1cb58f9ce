"""The misconceptions that explain wrong answers.

Importing this package registers all misconceptions: its modules register their own.
"""

import service.grading.diagnosis.formulas.formula_repair
import service.grading.diagnosis.formulas.formula_rewriting
import service.grading.diagnosis.formulas.quantity
import service.grading.diagnosis.lists.angle
import service.grading.diagnosis.lists.angle_sum
import service.grading.diagnosis.lists.euler_triple
import service.grading.diagnosis.lists.position
import service.grading.diagnosis.lists.value_list
import service.grading.diagnosis.matrices.exponentials
import service.grading.diagnosis.matrices.home_position
import service.grading.diagnosis.matrices.inverse_slips
import service.grading.diagnosis.matrices.line_signs
import service.grading.diagnosis.matrices.link_slips
import service.grading.diagnosis.matrices.matrix_case
import service.grading.diagnosis.matrices.matrix_entry
import service.grading.diagnosis.matrices.rotation_steps
import service.grading.diagnosis.matrices.whole_matrix
import service.grading.diagnosis.motions.given_motion
import service.grading.diagnosis.motions.link_products
import service.grading.diagnosis.motions.motion_slips
import service.grading.diagnosis.placements.frame_slips
import service.grading.diagnosis.screws.all_screws
import service.grading.diagnosis.screws.screw_axis
import service.grading.diagnosis.tables.cell_variables
import service.grading.diagnosis.tables.column_order
import service.grading.diagnosis.tables.dh_row
import service.grading.diagnosis.tables.intended_table
import service.grading.diagnosis.tables.joint_numbering
import service.grading.diagnosis.tables.length_unit
import service.grading.diagnosis.tables.rows_and_columns
import service.grading.diagnosis.tables.table_cell
import service.grading.diagnosis.tables.table_explained
import service.grading.diagnosis.tables.table_freedom
import service.grading.diagnosis.tables.whole_table
import service.grading.diagnosis.upstream.all_links
import service.grading.diagnosis.upstream.joint_slips
import service.grading.diagnosis.upstream.length_slips
import service.grading.diagnosis.upstream.missing_symbol
import service.grading.diagnosis.upstream.slip
import service.grading.diagnosis.upstream.slip_kinds
import service.grading.diagnosis.upstream.slip_search
import service.grading.diagnosis.upstream.slipped_answers
import service.grading.diagnosis.upstream.slipped_link
import service.grading.diagnosis.upstream.table_slips
import service.grading.diagnosis.wording
import service.grading.diagnosis.wrong_value
