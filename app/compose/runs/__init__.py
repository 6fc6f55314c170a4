"""Services and records of a run: the journal, the event log and the error log."""
