"""Tests of programs as polylines."""
