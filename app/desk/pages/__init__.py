"""Code that the pages share, such as tables, keys, code help and the conditions for opening a page."""
