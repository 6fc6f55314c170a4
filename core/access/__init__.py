"""Who may change what: levels, what each may change, PINs."""
