"""A pendant, dial or gamepad on USB, read by the input layer of the kernel (evdev). It starts nothing."""
