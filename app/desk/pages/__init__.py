"""Code that the pages share: tables, keys, help with codes and the conditions for opening a page."""
