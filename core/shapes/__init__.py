"""Shapes: a face, a groove, a thread as fields, the plain OmniTurn lines that cut it, and back again."""
