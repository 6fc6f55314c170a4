"""The drivers in a process of their own: it owns the bus and the queue, and outlives a control that dies."""
