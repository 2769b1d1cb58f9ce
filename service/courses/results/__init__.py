"""The points of a course: the gradebook, also as a workbook."""
