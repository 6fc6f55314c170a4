"""Proving of many programs on all cores, with a cache of proofs."""
