"""Connection, checking and simulation of machines by the backend in their machine file."""
