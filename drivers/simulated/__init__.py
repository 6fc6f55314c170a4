"""Backend that connects the ports to the simulated machine."""
