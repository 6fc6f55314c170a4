"""Moves of OmniTurn: lines, arcs, corners, nose compensation, the C axis and plane switching."""
