"""A syntax tree -> text, LaTeX, MathML."""
