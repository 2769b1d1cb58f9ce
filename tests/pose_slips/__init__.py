"""Single slips of tables in poses, orientations, positions and link transforms: are they named?"""
