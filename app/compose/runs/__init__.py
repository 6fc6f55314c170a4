"""Services and records of a run, which are the journal, the event log and the error log."""
