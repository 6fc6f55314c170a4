"""Cycles of Klartext: holes, pockets, contours and the patterns of their places."""
