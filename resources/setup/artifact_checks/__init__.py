"""Checks of the release artifacts: installation, first part, upgrade and removal in minimal systems."""
