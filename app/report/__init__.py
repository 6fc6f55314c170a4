"""A proof on paper: one HTML file that opens anywhere, with drawings of part, path and tools."""
