"""Tests of the documents: links, form, words and commands."""
