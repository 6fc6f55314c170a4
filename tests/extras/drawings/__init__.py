"""Drawings: read, picked, turned; and those that no contour can be taken from."""
