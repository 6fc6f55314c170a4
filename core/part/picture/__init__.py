"""Pictures of the part in space: surface points, lighting, edges, and the chuck and the tool around it."""
