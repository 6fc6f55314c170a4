"""Drivers: one folder for each kind of machine, all behind ``core.ports``."""
