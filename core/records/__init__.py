"""Scope records: channels, the ring in memory and on the disk, record files and analyses."""
