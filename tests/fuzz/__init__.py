"""Fuzzing by coverage: outside of the tests, by hand and for as long as one likes."""
