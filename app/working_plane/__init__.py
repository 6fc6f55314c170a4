"""3D view of a mill with rotary axes, which shows table, blank, working plane and tool."""
