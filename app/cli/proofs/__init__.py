"""Proving of many programs, on all cores and once only."""
