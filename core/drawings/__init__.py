"""Drawings, DXF and SVG: read, the contour of a turned part picked out of them, and programs made of it."""
