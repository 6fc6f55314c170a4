"""Subprograms, jumps, variables and block search of SINUMERIK."""
