"""Model and view of the SPECIAL FUNCTIONS page (F10)."""
