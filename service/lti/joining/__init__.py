"""How platforms join: by invitation (dynamic registration), or with a file of our values."""
