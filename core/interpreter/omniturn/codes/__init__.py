"""Table of the OmniTurn codes, its rules, and the pages that are generated from it."""
