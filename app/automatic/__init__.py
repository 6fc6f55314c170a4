"""Automatic page. Its model is ``Desk``."""
