"""The misconceptions that explain wrong answers.

Importing this package registers all misconceptions: each file registers its own. The engine that
tries them is ``misconception.py``; tables are in the files with "table" in their names.
"""

import dh_grader.grading.diagnosis.formulas
import dh_grader.grading.diagnosis.lists
import dh_grader.grading.diagnosis.matrices
import dh_grader.grading.diagnosis.motions
import dh_grader.grading.diagnosis.products
import dh_grader.grading.diagnosis.screws_and_placements
import dh_grader.grading.diagnosis.slips_of_the_table
import dh_grader.grading.diagnosis.table_cells
import dh_grader.grading.diagnosis.table_readings
import dh_grader.grading.diagnosis.upstream
import dh_grader.grading.diagnosis.whole_tables
import dh_grader.grading.misconception
