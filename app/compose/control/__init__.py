"""The control in a process of its own: executor and drivers there, the screen is its client."""
