"""F10, the special functions: the page."""
