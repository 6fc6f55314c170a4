"""The path view, which draws, pans, zooms and measures the path of a program as polylines."""
