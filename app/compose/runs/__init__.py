"""Services and records of a run: journal, event log and error log."""
