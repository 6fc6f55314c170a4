"""Proving of many programs on all CPU cores, with a cache of proofs."""
