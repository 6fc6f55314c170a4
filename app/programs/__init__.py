"""Page PROGRAMS: list, preview, copy, rename, delete, import and export; model and view."""
