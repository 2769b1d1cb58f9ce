"""The gradebook of a course, also as a workbook for spreadsheet programs."""
