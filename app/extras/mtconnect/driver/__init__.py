"""MTConnect SHDR adapter, which reports values and accepts no commands."""
