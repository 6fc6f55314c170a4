"""Machine files, and the program setups, setup files and manual pages that are made from them."""
