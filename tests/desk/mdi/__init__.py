"""Models without a screen."""
