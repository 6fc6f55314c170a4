"""The table of OmniTurn codes, its rules and the pages that are made of it."""
