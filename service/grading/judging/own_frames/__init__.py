"""Tables in frames of the student's own choice: the valid table nearest to the one handed in.

``own`` reads a table: as it is or with a cell or two mended (``nearest``), as it was meant
(``meant``), or else by the search of ``kinematics.frame_choice``. ``roles`` says which row is for
which joint, ``mechanism`` what the reference is, ``choices`` what a student is told of the frames.
"""
