-- What is measured on parts. Lengths mm, a diameter is a diameter; low and high are deviations from the nominal.
-- A feature that is retired is measured no more, and keeps its readings. grows: what it does when the correction
-- of by_kind, number grows: 1 grows, -1 shrinks. every: so many parts apart, 0 no plan.
CREATE TABLE part_features (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    program TEXT NOT NULL,
    name TEXT NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('diameter', 'length')),
    nominal REAL NOT NULL,
    low REAL NOT NULL,
    high REAL NOT NULL CHECK (high > low),
    by_kind TEXT NOT NULL CHECK (by_kind IN ('tool', 'secondary')),
    number INTEGER NOT NULL CHECK (number BETWEEN 1 AND 32),
    grows INTEGER NOT NULL CHECK (grows IN (1, -1)),
    every INTEGER NOT NULL CHECK (every >= 0),
    sample INTEGER NOT NULL CHECK (sample BETWEEN 1 AND 10),
    retired INTEGER NOT NULL DEFAULT 0 CHECK (retired IN (0, 1))
);
CREATE UNIQUE INDEX part_features_by_name ON part_features (program, name) WHERE retired = 0;
-- part: its number among those of the program. unit is that in which it was read; void: taken out again.
CREATE TABLE part_readings (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    feature INTEGER NOT NULL REFERENCES part_features (id),
    part INTEGER NOT NULL CHECK (part >= 0),
    value REAL NOT NULL,
    unit TEXT NOT NULL CHECK (unit IN ('in', 'mm')),
    at TEXT NOT NULL,
    source TEXT NOT NULL CHECK (source IN ('typed', 'gauge')),
    gauge TEXT NOT NULL,
    void INTEGER NOT NULL DEFAULT 0 CHECK (void IN (0, 1))
);
CREATE INDEX part_readings_by_feature ON part_readings (feature);
-- What an insert has made since it was changed, and what it may; seconds at feed. A limit of 0 is none.
CREATE TABLE tool_lives (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    limit_parts INTEGER NOT NULL DEFAULT 0 CHECK (limit_parts >= 0),
    limit_seconds REAL NOT NULL DEFAULT 0 CHECK (limit_seconds >= 0),
    warn REAL NOT NULL DEFAULT 0.9 CHECK (warn > 0 AND warn <= 1),
    stops INTEGER NOT NULL DEFAULT 0 CHECK (stops IN (0, 1)),
    parts INTEGER NOT NULL DEFAULT 0 CHECK (parts >= 0),
    seconds REAL NOT NULL DEFAULT 0 CHECK (seconds >= 0)
);
CREATE TABLE insert_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    at TEXT NOT NULL,
    number INTEGER NOT NULL,
    parts INTEGER NOT NULL,
    seconds REAL NOT NULL,
    why TEXT NOT NULL
);
-- One row a part that was begun; its key tells it from all others, whatever the clock does. ended NULL: the
-- control ended in its middle. part 0: no part was counted. seconds: without stops. offset_change: the newest
-- change of an offset when it was begun. load: of the spindle, per cent, where a drive tells it.
CREATE TABLE part_cycles (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    key TEXT NOT NULL UNIQUE,
    program TEXT NOT NULL,
    part INTEGER NOT NULL DEFAULT 0,
    started TEXT NOT NULL,
    ended TEXT,
    seconds REAL NOT NULL DEFAULT 0,
    outcome TEXT NOT NULL DEFAULT '',
    offset_change INTEGER NOT NULL,
    load REAL
);
CREATE INDEX part_cycles_by_program ON part_cycles (program, part);
-- Why production stood, and how long; the cycle that it stood in, empty between two of them.
CREATE TABLE production_stops (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    key TEXT NOT NULL UNIQUE,
    cycle TEXT NOT NULL,
    program TEXT NOT NULL,
    at TEXT NOT NULL,
    seconds REAL NOT NULL,
    reason TEXT NOT NULL,
    line INTEGER NOT NULL
);
