"""Proof that a converted program moves and acts as its source does."""
