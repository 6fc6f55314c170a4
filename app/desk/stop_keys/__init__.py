"""Separate connection that sends the keyboard's stop keys to the control, bypassing the screen."""
