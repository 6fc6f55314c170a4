"""3D view of a mill with rotary axes: table, blank, working plane and tool."""
