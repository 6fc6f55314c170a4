"""Damaged and hostile input: by seeded damage in the tests, by coverage (``tests.fuzz.fuzz``) by hand."""
