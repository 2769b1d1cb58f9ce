"""Read submitted matrices and screw axes as entries."""
