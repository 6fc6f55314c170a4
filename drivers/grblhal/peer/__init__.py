"""A look-alike of the controller, with the habits of the real one: for trying without hardware."""
