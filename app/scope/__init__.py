"""The scope: figures of the machine as curves over time, live and from records."""
