"""Separate connection that sends stop key presses to the control, bypassing the screen."""
