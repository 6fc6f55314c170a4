"""SEARCHTO: restart in the middle of a program, and retract from the part."""
