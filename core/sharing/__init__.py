"""Programs shared between desks: in a folder, in a git repository, in PostgreSQL."""
