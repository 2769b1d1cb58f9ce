"""Texts and formulas as students read them: names and matrices in MathML."""
