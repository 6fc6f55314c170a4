"""Scope: machine signals as curves over time, live and from records."""
