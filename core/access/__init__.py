"""Access control: levels, the permitted changes of each level, and PINs."""
