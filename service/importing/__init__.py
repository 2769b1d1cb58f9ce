"""Import robots from other programs: from a URDF file or a DH table to an exercise file."""
