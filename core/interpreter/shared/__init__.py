"""Components that the interpreters of all dialects share, such as elementary blocks and the modal state."""
