"""SEARCHTO: a program goes on from any good line."""
