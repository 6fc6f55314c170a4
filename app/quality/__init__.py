"""Measured parts, tool life and trends: what is written of every part, and the pages that show it."""
