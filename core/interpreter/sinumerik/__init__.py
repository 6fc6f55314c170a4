"""Interpreter of the SINUMERIK turning dialect, in which C is the third axis."""
