"""What the interpreters of all dialects share: elementary blocks, modal state, one pass through a program."""
