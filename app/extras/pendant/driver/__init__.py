"""Driver for a USB pendant, dial or gamepad, which uses the Linux input layer (evdev).

The device cannot start motion.
"""
