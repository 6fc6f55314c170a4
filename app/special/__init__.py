"""The page SPECIAL FUNCTIONS (F10): model and view."""
