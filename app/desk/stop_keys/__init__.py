"""The stop keys of the keyboard on a path of their own, past the screen."""
