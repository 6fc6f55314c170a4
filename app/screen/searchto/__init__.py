"""The SEARCHTO page."""
