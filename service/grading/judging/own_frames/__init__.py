"""Judge tables in a student's own frames: find the valid table nearest to a submitted one.

A table is valid if it describes the robot, in any frames that the convention allows. The modules,
in the order in which they are used:

- ``row_roles``: which row belongs to which joint, and what the exercise leaves free
- ``rounded_angles``: read 1.57 as π/2
- ``rounded_cells``: find the exact numbers of all rounded decimals of a table
- ``nearest_table``: find the valid table nearest to such rows, in one of these ways:

  - ``few_cells``: the table as written, or with one or two repaired cells, if base, tool and
    directions are given; ``slip_likelihood`` chooses the likeliest of several repairs
  - ``written_table``: the intended table, if the student mistook the convention or the unit
  - ``base_frame``: the table as written, from the student's base
  - ``one_cell``: the table with one repaired cell, if base, tool or directions are free
  - ``kinematics.frame_choice``: a search row by row; for this search, ``constants`` separates
    constants and joint variables, and ``validity`` lists the axes or frames that rows lead to

- ``best_roles``: choose the pairing of rows and joints with the nearest valid table
- ``remarks``: messages on valid frames that differ from the reference frames

``reference`` converts the reference table to the forms that the other modules need.
"""
