"""The points of a course: the gradebook, and the workbook that contains the gradebook."""
