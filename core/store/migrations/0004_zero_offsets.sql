-- Settable offsets G54 to G59 of SINUMERIK programs: mm, X a radius, C in degrees. One that is missing is all 0.
CREATE TABLE zero_offsets (
    code INTEGER PRIMARY KEY CHECK (code BETWEEN 54 AND 59),
    x REAL NOT NULL,
    z REAL NOT NULL,
    c REAL NOT NULL
);
-- As offset_changes: one step is what one entry changed; NULL: the offset was, or became, not set.
CREATE TABLE zero_offset_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    step INTEGER NOT NULL,
    undoes INTEGER,
    at TEXT NOT NULL,
    code INTEGER NOT NULL,
    old_x REAL, old_z REAL, old_c REAL,
    new_x REAL, new_z REAL, new_c REAL,
    why TEXT NOT NULL,
    who TEXT NOT NULL
);
CREATE INDEX zero_offset_changes_by_step ON zero_offset_changes (step);
