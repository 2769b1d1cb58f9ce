"""Check that slips in a table are named in poses, orientations, positions and link transforms."""
