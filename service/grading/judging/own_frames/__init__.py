"""Tables in frames of the student's own choice: the valid table nearest to the one handed in.

In the order in which they are used:

- ``row_roles``: which row is for which joint, and what the exercise leaves free
- ``rounded_angles``: 1.57 read as the π/2 that it stands for
- ``rounded_cells``: the numbers that all rounded decimals of a table stand for
- ``nearest_table``: the valid table nearest to such rows, found in one of these ways:

  - ``few_cells``: the table as written, or with one or two cells repaired, where base, tool and
    directions are given; of several repairs ``slip_likelihood`` finds the likeliest
  - ``written_table``: the intended table, if the convention or the unit was mistaken
  - ``base_frame``: the table as written, from a base of the student's
  - ``one_cell``: the table with one cell repaired, where base, tool or directions are free
  - ``kinematics.frame_choice``: a search row by row; ``constants`` takes the table apart for it,
    ``validity`` names the targets of its rows

- ``best_roles``: of several ways to pair rows and joints, the one with the nearest valid table
- ``remarks``: where the student's frames are valid but not the reference's

``reference`` holds the reference in the forms that the others need; ``validity`` also tests many
tables at once.
"""
