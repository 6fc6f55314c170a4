"""Documentation site, built from the Markdown pages of the repository."""
