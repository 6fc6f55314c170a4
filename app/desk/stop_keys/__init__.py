"""Separate connection of the keyboard's stop keys to the control, which does not depend on the screen."""
