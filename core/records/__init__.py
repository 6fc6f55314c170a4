"""Scope records: channels, the ring buffer in memory and on disk, record files, and analyses."""
