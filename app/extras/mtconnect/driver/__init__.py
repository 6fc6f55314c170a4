"""MTConnect adapter (SHDR protocol), which reports values and accepts no commands."""
