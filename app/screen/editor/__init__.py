"""The F3 editor on the screen."""
