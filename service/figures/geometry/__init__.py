"""The geometry of a figure: the chain, its mechanism and the view."""
