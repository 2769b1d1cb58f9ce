"""The points of a course: the gradebook, and the workbook with it."""
