"""An MTConnect SHDR adapter. It reports the values that it is given, and accepts no commands."""
