"""Table of the OmniTurn codes and their rules, and generators of pages from this table."""
