"""The control in a process of its own, and its screen."""
