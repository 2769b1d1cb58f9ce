"""Recording of attempts in a database. Grading works without it."""
