"""The page PART: stock and findings of the program on the desk."""
