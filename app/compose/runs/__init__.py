"""Services and records of a program run: the journal, the event log and the error log."""
