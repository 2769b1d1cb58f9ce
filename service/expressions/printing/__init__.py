"""Print a syntax tree as text, LaTeX or MathML."""
