"""What the screen shows of a mill with rotary axes: positions in the working plane, and the 3-D view."""
