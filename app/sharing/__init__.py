"""The programs of this desk and those of the other desks: what is shared, what is newer elsewhere."""
