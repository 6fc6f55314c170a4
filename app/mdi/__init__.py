"""MDI: one line at a time, proved before it may run."""
