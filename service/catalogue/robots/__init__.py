"""The reference robot of an exercise, from which right answers are computed."""
