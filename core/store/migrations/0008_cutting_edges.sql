-- Cutting edges D2 to D9 of a tool are rows of the tables of tools, under D * 100000 + T; D1 is the tool's own row.
CREATE TABLE tool_offsets_with_edges (
    number INTEGER PRIMARY KEY
        CHECK (number % 100000 BETWEEN 1 AND 32 AND number / 100000 BETWEEN 0 AND 9 AND number / 100000 <> 1),
    x REAL NOT NULL,
    z REAL NOT NULL,
    r REAL NOT NULL CHECK (r >= 0),
    wear_x REAL NOT NULL DEFAULT 0,
    wear_z REAL NOT NULL DEFAULT 0,
    quadrant INTEGER NOT NULL DEFAULT 0 CHECK (quadrant BETWEEN 0 AND 9),
    remark TEXT NOT NULL DEFAULT '',
    master INTEGER NOT NULL DEFAULT 0 CHECK (master IN (0, 1) AND (master = 0 OR number < 100000))
);
INSERT INTO tool_offsets_with_edges SELECT number, x, z, r, wear_x, wear_z, quadrant, remark, master FROM tool_offsets;
DROP TABLE tool_offsets;
ALTER TABLE tool_offsets_with_edges RENAME TO tool_offsets;
CREATE UNIQUE INDEX tool_offsets_one_master ON tool_offsets (master) WHERE master = 1;
CREATE TABLE tool_shapes_with_edges (
    number INTEGER PRIMARY KEY
        CHECK (number % 100000 BETWEEN 1 AND 32 AND number / 100000 BETWEEN 0 AND 9 AND number / 100000 <> 1),
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
INSERT INTO tool_shapes_with_edges SELECT * FROM tool_shapes;
DROP TABLE tool_shapes;
ALTER TABLE tool_shapes_with_edges RENAME TO tool_shapes;
