"""Page SPECIAL FUNCTIONS (F10): model and view."""
