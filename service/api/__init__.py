"""The HTTP interface. Thin: parse, call, answer."""
