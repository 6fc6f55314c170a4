"""The other end of the bus: drives and terminals of the simulated machine behind real CAN frames."""
