"""Report of a proof as one self-contained HTML file, with drawings of part, path and tools."""
