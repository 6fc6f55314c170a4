"""The backend that connects the ports to the simulated machine."""
