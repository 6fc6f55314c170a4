"""The part and its material: tool shapes and outlines, stock, and material removal.

Dimensions are in mm, with X as a radius.
"""
