"""Restart in the middle of a program: suitable lines, inherited state, retract and approach."""
