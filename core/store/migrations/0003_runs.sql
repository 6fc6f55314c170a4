-- What each program has done: one row a program, so that it never grows. NULL: not yet. Times s, UTC as before.
CREATE TABLE runs (
    program TEXT PRIMARY KEY,
    started TEXT,
    outcome TEXT NOT NULL DEFAULT '',
    cycles INTEGER NOT NULL DEFAULT 0,
    best REAL,
    latest REAL,
    proved TEXT,
    proof TEXT NOT NULL DEFAULT '',
    planned REAL
);
