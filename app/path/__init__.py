"""Path view: the path of a program as polylines, with drawing, panning, zooming and measuring."""
