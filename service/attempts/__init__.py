"""Recorded attempts: a database that a course can do without, and loses nothing with."""
