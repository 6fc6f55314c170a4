"""Look-alikes: the far ends of the drivers' wires, played by us for simulation, tests and benches."""
