"""Machine data that other programs can read but not change."""
