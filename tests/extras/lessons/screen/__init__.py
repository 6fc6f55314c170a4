"""The screen of the conversion."""
