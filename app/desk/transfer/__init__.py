"""Programs over the serial line: models without Qt."""
