"""Choose random values of joints and link parameters, and compare numbers at these values."""
