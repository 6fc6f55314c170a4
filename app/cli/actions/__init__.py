"""What commands do, imported only when they do it."""
