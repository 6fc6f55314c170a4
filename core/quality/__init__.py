"""Measured parts: control charts, capability, drift, proposed wear; tool life, stops, availability."""
