"""The part as metal: tool shapes and their outlines, stock, removal. Millimetres, X a radius."""
