"""Records of the scope: their channels, the ring and its file, and what is read off them."""
