"""What the shop floor is told of the machine: a display like any other, for programs instead of people."""
