"""Connection, checking and simulation of machines through the backend named in the machine file."""
