"""SEARCHTO function, which restarts in the middle of a program or retracts from the part."""
