"""The MDI page."""
