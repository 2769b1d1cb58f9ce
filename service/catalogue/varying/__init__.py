"""The table ``[vary]`` of an exercise file, which gives students different numbers."""
