"""The control in a separate process with executor and drivers; the operator screen is its client."""
