-- Lengths are mm, X a radius. Times are UTC, ISO 8601; the order of things is that of their ids, because a
-- wall clock may be set back.
CREATE TABLE programs (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    created TEXT NOT NULL
);
CREATE TABLE program_versions (
    id INTEGER PRIMARY KEY,
    program INTEGER NOT NULL REFERENCES programs (id),
    number INTEGER NOT NULL CHECK (number >= 1),
    text BLOB NOT NULL,
    sha256 TEXT NOT NULL,
    saved TEXT NOT NULL,
    why TEXT NOT NULL,
    UNIQUE (program, number)
);
CREATE TABLE tool_offsets (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    x REAL NOT NULL,
    z REAL NOT NULL,
    r REAL NOT NULL CHECK (r >= 0)
);
CREATE TABLE secondary_offsets (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    x REAL NOT NULL,
    z REAL NOT NULL,
    r REAL NOT NULL CHECK (r >= 0)
);
-- One step is what one entry of the operator changed. NULL: the offset was, or became, not set.
CREATE TABLE offset_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    step INTEGER NOT NULL,
    undoes INTEGER,
    at TEXT NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('tool', 'secondary')),
    number INTEGER NOT NULL,
    old_x REAL, old_z REAL, old_r REAL,
    new_x REAL, new_z REAL, new_r REAL,
    why TEXT NOT NULL,
    who TEXT NOT NULL
);
CREATE INDEX offset_changes_by_step ON offset_changes (step);
CREATE TABLE events (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    at TEXT NOT NULL,
    kind TEXT NOT NULL,
    text TEXT NOT NULL,
    line INTEGER NOT NULL DEFAULT 0
);
CREATE TABLE part_counts (
    program TEXT PRIMARY KEY,
    count INTEGER NOT NULL CHECK (count >= 0),
    last TEXT NOT NULL
);
CREATE TABLE settings (
    key TEXT PRIMARY KEY,
    value TEXT NOT NULL
);
