"""Tool calls, M functions and coordinate transformations of Klartext."""
