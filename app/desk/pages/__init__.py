"""Code that the pages share: tables, keys, code help and the conditions for opening a page."""
