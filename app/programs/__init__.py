"""The page PROGRAMS: list, preview, copy, rename, delete, import and export of programs; model and view."""
