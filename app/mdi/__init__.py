"""MDI page, on which the operator enters one line at a time. Each line is proved before it runs."""
