"""Production data, which consists of tool life, cycles and stops."""
