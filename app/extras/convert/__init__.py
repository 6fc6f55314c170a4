"""Optional feature with the command ``turndesk convert``."""
