"""Shop-floor data: an MTConnect SHDR adapter. It tells what it is given and takes no orders."""
