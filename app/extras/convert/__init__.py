"""Command ``turndesk convert``."""
