"""Tests of the conversion of programs of other controls."""
