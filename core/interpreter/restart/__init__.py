"""Restart in the middle of a program, with possible lines, inherited state, retract and approach."""
