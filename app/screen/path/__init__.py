"""The parts of the path view."""
