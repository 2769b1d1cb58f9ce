"""A report in the forms that people and programs take it in; one file for each."""
