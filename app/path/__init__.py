"""The path view: a program's path as polylines, drawn, measured and looked around in."""
