"""Shapes: forms, the lines that they write, and read back."""
