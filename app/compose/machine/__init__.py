"""Machine files, and the program contexts, setup files and manual pages made from them."""
