"""The simulated machine as a backend: the plant of the look-alikes behind ``core.ports``."""
