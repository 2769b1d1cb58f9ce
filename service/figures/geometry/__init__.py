"""The geometry of a figure: the path of the chain, its mechanism and the view."""
