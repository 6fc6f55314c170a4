"""Access control: levels, the changes that each level permits, and PINs."""
