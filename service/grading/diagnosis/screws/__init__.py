"""The slips in screw axes."""
