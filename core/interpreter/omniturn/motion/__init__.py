"""Moves of OmniTurn: lines, arcs, corners, nose compensation, C axis and plane switching."""
