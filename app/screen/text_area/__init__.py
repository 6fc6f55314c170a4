"""Multi-line text area for texts of any length."""
