"""Which slip explains a wrong answer: small pure functions, one for each misconception."""
