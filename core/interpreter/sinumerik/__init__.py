"""Interpreter of the SINUMERIK turning dialect, with C as the third axis."""
