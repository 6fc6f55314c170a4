"""Programs shared between desks: in a folder or in PostgreSQL."""
