"""Scripts and sessions in MATLAB or Python."""
