"""Drivers, with one folder per kind of machine, all of which implement ``core.ports``."""
