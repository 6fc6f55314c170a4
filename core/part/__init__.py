"""The part and its material: tool shapes and outlines, stock, and removal, in mm with X as a radius."""
