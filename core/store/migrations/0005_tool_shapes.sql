-- Shapes of tools, beside their offsets: a tool may have one before it was ever touched off. Lengths mm, degrees.
-- Nose radius and tip quadrant stay where they are, with the offset. Outlines are texts in mm: "z,x z,x z,x".
CREATE TABLE tool_shapes (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    kind TEXT NOT NULL,
    hand TEXT NOT NULL,
    insert_code TEXT NOT NULL,
    holder TEXT NOT NULL,
    width REAL NOT NULL,
    diameter REAL NOT NULL,
    point REAL NOT NULL,
    stick_out REAL NOT NULL,
    length REAL NOT NULL,
    pitch REAL NOT NULL,
    flutes INTEGER NOT NULL,
    entry REAL NOT NULL,
    rear INTEGER NOT NULL CHECK (rear IN (0, 1)),
    profile TEXT NOT NULL
);
-- As offset_changes: one step is what one entry changed; NULL: the tool had, or has, no shape.
CREATE TABLE tool_shape_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    step INTEGER NOT NULL,
    undoes INTEGER,
    at TEXT NOT NULL,
    number INTEGER NOT NULL,
    old_kind TEXT, old_hand TEXT, old_insert_code TEXT, old_holder TEXT,
    old_width REAL, old_diameter REAL, old_point REAL, old_stick_out REAL, old_length REAL, old_pitch REAL,
    old_flutes INTEGER, old_entry REAL, old_rear INTEGER, old_profile TEXT,
    new_kind TEXT, new_hand TEXT, new_insert_code TEXT, new_holder TEXT,
    new_width REAL, new_diameter REAL, new_point REAL, new_stick_out REAL, new_length REAL, new_pitch REAL,
    new_flutes INTEGER, new_entry REAL, new_rear INTEGER, new_profile TEXT,
    why TEXT NOT NULL,
    who TEXT NOT NULL
);
CREATE INDEX tool_shape_changes_by_step ON tool_shape_changes (step);
