"""The screen of the tour."""
