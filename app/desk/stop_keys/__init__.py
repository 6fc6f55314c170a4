"""Separate connection from the keyboard's stop keys to the control, independent of the screen."""
