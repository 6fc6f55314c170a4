"""Going on in the middle of a program: which lines are good for it, what they inherit, the way there."""
