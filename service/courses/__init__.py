"""Courses: learners, assignments, extensions, personal links and the gradebook."""
