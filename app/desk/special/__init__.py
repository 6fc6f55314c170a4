"""F10, the special functions: models without Qt."""
