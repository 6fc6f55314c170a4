"""Tests of the pendant: events as the kernel writes them, on a pipe instead of a device."""
