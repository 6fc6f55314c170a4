"""Setup of a new computer.

The packages are locked by hash, listed with their licenses, and bundled in one file.
"""
