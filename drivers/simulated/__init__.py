"""The simulated machine as a backend: the plant of the simulators behind ``core.ports``."""
