"""A pendant, dial or gamepad on USB, by the kernel's input layer (evdev): wheel and buttons, no start."""
