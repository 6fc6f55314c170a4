"""Machine files, and the program setups, setup files and manual pages generated from them."""
