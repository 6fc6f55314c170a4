"""Pendant, dial or gamepad on USB, read through the kernel's input layer (evdev).

It cannot start motion.
"""
