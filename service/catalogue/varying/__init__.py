"""The table ``[vary]`` of an exercise file: choices, conditions, and the values of a seed."""
