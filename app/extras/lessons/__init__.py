"""Lessons on the operator screen: the list of lessons and the card with the current step."""
