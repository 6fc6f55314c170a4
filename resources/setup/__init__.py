"""Set-up: what a fresh machine gets: locked by hash, listed with its licences, in one file."""
