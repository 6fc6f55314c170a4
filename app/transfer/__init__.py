"""RS-232: sending and receiving programs over the serial line."""
