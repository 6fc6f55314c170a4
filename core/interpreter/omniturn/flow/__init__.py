"""Loops, subroutines and conditional calls of OmniTurn."""
