"""SEARCHTO: restart in the middle of a program, and the way out of the part."""
