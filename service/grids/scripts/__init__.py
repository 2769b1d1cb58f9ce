"""Read scripts and interpreter sessions in MATLAB or Python."""
