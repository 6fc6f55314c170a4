"""Restart in the middle of a program: possible lines, inherited state, retract and approach."""
