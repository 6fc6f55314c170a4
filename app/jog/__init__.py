"""Jog page with manual axis motion, homing, tool setting and touch-off."""
