"""Tool calls, M functions and shifted or turned datums of Klartext."""
