"""Scope page that shows machine signals as curves over time, live and from records."""
