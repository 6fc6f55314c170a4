"""Model and view of the PROGRAMS page.

The page lists, previews, copies, renames, deletes, imports and exports programs.
"""
