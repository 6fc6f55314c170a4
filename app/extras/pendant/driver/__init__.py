"""Driver for a USB pendant, dial or gamepad, which uses the input layer of the kernel (evdev).

The device cannot start motion.
"""
