"""The Jog page: manual axis motion, homing, tool setting and touch-off."""
