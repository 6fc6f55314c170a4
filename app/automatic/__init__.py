"""Page of the screen for running programs automatically. Its model is ``Desk``."""
