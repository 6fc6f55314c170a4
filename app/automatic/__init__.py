"""Automatic page, whose model is ``Desk``."""
