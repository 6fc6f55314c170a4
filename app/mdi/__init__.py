"""MDI page for the entry of one line at a time, which is proved before it runs."""
