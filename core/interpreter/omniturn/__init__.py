"""OmniTurn programs to elementary blocks: each family of G and M codes in a file of its own."""
