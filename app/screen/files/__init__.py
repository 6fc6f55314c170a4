"""The list of programs: the page."""
