"""The editor by keys."""
