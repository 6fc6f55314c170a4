"""SEARCHTO function, which restarts a program at a selected line or retracts the tool."""
