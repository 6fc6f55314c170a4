-- Tools of a mill: lengths mm (L, R, R2 and their oversizes DL, DR, DR2), point angle in degrees, life in minutes; 0: none.
CREATE TABLE mill_tools (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 999),
    name TEXT NOT NULL,
    length REAL NOT NULL,
    radius REAL NOT NULL,
    corner REAL NOT NULL,
    dl REAL NOT NULL,
    dr REAL NOT NULL,
    dr2 REAL NOT NULL,
    teeth INTEGER NOT NULL,
    point REAL NOT NULL,
    life REAL NOT NULL
);
CREATE TABLE mill_tool_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    step INTEGER NOT NULL,
    undoes INTEGER,
    at TEXT NOT NULL,
    number INTEGER NOT NULL,
    old_name TEXT, old_length REAL, old_radius REAL, old_corner REAL, old_dl REAL, old_dr REAL, old_dr2 REAL, old_teeth INTEGER, old_point REAL, old_life REAL,
    new_name TEXT, new_length REAL, new_radius REAL, new_corner REAL, new_dl REAL, new_dr REAL, new_dr2 REAL, new_teeth INTEGER, new_point REAL, new_life REAL,
    why TEXT NOT NULL,
    who TEXT NOT NULL
);
CREATE INDEX mill_tool_changes_by_step ON mill_tool_changes (step);
-- Presets of a mill: machine position of the workpiece's zero, mm, and its turn about Z, degrees. Changes as offset_changes.
CREATE TABLE datum_presets (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 99),
    x REAL NOT NULL,
    y REAL NOT NULL,
    z REAL NOT NULL,
    rotation REAL NOT NULL,
    remark TEXT NOT NULL
);
CREATE TABLE datum_preset_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    step INTEGER NOT NULL,
    undoes INTEGER,
    at TEXT NOT NULL,
    number INTEGER NOT NULL,
    old_x REAL, old_y REAL, old_z REAL, old_rotation REAL, old_remark TEXT,
    new_x REAL, new_y REAL, new_z REAL, new_rotation REAL, new_remark TEXT,
    why TEXT NOT NULL,
    who TEXT NOT NULL
);
CREATE INDEX datum_preset_changes_by_step ON datum_preset_changes (step);
