"""Page PART: stock and findings of the loaded program."""
