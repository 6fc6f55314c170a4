"""Search in the lists of the screen, and keys that move the selection of a list."""
