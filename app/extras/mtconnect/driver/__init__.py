"""MTConnect SHDR adapter that reports values and accepts no commands."""
