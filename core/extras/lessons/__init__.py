"""Lessons for beginners: their files, the conditions of their steps, and the progress of the operator."""
