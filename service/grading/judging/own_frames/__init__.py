"""Judge a table in the frames that the student chose.

A table is valid if it describes the robot in any frames that the convention allows. The student's
table is compared with the valid table nearest to it.
"""

# The modules, in the order in which they are used:
# - ``row_roles``: which row belongs to which joint, and which frames the student may choose
# - ``rounding``: the exact numbers of rounded decimals
# - ``nearest``: the valid table nearest to such rows. ``few_cells`` is for a given base, tool and
#   directions; ``one_cell`` and ``kinematics.frame_choice`` are for frames that are chosen
# - ``written_table``: the intended table, if the student mistook the convention or the unit
# - ``base_frame``: the poses that a chosen base may have
# - ``best_roles``: the pairing of rows and joints with the nearest valid table
# - ``remarks``: messages on valid frames that differ from the reference frames
