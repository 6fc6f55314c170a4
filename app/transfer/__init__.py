"""Sending and receiving of programs over the RS-232 serial line."""
