"""The list of programs: models without Qt."""
