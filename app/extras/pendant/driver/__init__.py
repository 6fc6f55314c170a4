"""Driver for a USB pendant, dial or gamepad that uses the Linux input layer (evdev).

The device cannot start motion.
"""
