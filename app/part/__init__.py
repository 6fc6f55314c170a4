"""The PART page, with the stock and the findings of the loaded program."""
