"""Connection, checking and simulation of machines by the backend that their machine file specifies."""
