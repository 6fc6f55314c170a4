"""Scope page that shows machine signals as curves over time, live or from recordings."""
