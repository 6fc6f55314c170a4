"""MDI page for single program lines, each of which is proved before it runs."""
