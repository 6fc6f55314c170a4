"""Separate path of the keyboard's stop keys to the control, independent of the screen."""
