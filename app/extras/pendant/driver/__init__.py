"""Driver for a USB pendant, dial or gamepad, which is read through the input layer of the kernel (evdev).

The device cannot start motion.
"""
