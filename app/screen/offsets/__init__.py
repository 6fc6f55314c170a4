"""F8 and F9: tables of offsets with their dialogue."""
