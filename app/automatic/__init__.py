"""The Automatic page. Its model is ``Desk``."""
