PRAGMA application_id = 1416983118;
PRAGMA user_version = 17;
BEGIN TRANSACTION;
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
, old_a REAL, old_b REAL, old_c REAL, new_a REAL, new_b REAL, new_c REAL);
CREATE TABLE datum_presets (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 99),
    x REAL NOT NULL,
    y REAL NOT NULL,
    z REAL NOT NULL,
    rotation REAL NOT NULL,
    remark TEXT NOT NULL
, a REAL NOT NULL DEFAULT 0, b REAL NOT NULL DEFAULT 0, c REAL NOT NULL DEFAULT 0);
CREATE TABLE events (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    at TEXT NOT NULL,
    kind TEXT NOT NULL,
    text TEXT NOT NULL,
    line INTEGER NOT NULL DEFAULT 0
, record TEXT NOT NULL DEFAULT '', who TEXT NOT NULL DEFAULT '', message TEXT NOT NULL DEFAULT '');
INSERT INTO "events" VALUES(1,'2026-11-30T08:58:42.859Z','start','peg.nc',0,'','','');
CREATE TABLE insert_changes (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    at TEXT NOT NULL,
    number INTEGER NOT NULL,
    parts INTEGER NOT NULL,
    seconds REAL NOT NULL,
    why TEXT NOT NULL
, kind TEXT NOT NULL DEFAULT 'tool', who TEXT NOT NULL DEFAULT '');
CREATE TABLE jobs (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    place INTEGER NOT NULL,
    program TEXT NOT NULL,
    wanted INTEGER NOT NULL CHECK (wanted BETWEEN 1 AND 9999999),
    made INTEGER NOT NULL DEFAULT 0,
    base INTEGER,
    note TEXT NOT NULL DEFAULT '',
    added TEXT NOT NULL
);
INSERT INTO "jobs" VALUES(1,1,'peg.nc',3,0,NULL,'','2026-11-30T08:58:42.883Z');
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
, old_stops INTEGER, new_stops INTEGER);
CREATE TABLE mill_tool_lives (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 999),
    parts INTEGER NOT NULL DEFAULT 0 CHECK (parts >= 0),
    seconds REAL NOT NULL DEFAULT 0 CHECK (seconds >= 0)
);
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
, stops INTEGER NOT NULL DEFAULT 0 CHECK (stops IN (0, 1)));
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
, old_wear_x REAL, old_wear_z REAL, old_quadrant INTEGER, old_remark TEXT, old_master INTEGER, new_wear_x REAL, new_wear_z REAL, new_quadrant INTEGER, new_remark TEXT, new_master INTEGER);
INSERT INTO "offset_changes" VALUES(1,1,NULL,'2026-11-30T08:58:42.875Z','tool',1,NULL,NULL,NULL,1.25,-0.5,0.0,'first','operator',NULL,NULL,NULL,NULL,NULL,0.0,0.0,0,'',0);
INSERT INTO "offset_changes" VALUES(2,2,NULL,'2026-11-30T08:58:42.876Z','tool',1,1.25,-0.5,0.0,1.25,-0.5,0.0,'wear','operator',0.0,0.0,0,'',0,-0.004,0.0,0,'',0);
CREATE TABLE part_counts (
    program TEXT PRIMARY KEY,
    count INTEGER NOT NULL CHECK (count >= 0),
    last TEXT NOT NULL
);
INSERT INTO "part_counts" VALUES('peg.nc',1,'2026-11-30T08:58:42.878Z');
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
INSERT INTO "part_cycles" VALUES(1,'c1','peg.nc',1,'2026-12-01T08:30:00.000Z','2026-12-01T08:30:00.000Z',50.0,'COMPLETE',2,NULL);
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
INSERT INTO "part_features" VALUES(1,'peg.nc','SPIGOT','diameter',12.7,-0.05,0.05,'tool',1,1,0,1,0);
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
INSERT INTO "part_readings" VALUES(1,1,1,12.69,'in','2026-12-01T08:30:00.000Z','gauge','mic',0);
CREATE TABLE people (
    name TEXT PRIMARY KEY,
    level INTEGER NOT NULL CHECK (level BETWEEN 1 AND 3),
    salt BLOB NOT NULL,
    hash BLOB NOT NULL
);
INSERT INTO "people" VALUES('ANNA',3,X'73616C74',X'68617368');
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
INSERT INTO "production_stops" VALUES(1,'s1','c1','peg.nc','2026-12-01T08:30:00.000Z',4.0,'FEED HOLD',7);
CREATE TABLE program_versions (
    id INTEGER PRIMARY KEY,
    program INTEGER NOT NULL REFERENCES programs (id),
    number INTEGER NOT NULL CHECK (number >= 1),
    text BLOB NOT NULL,
    sha256 TEXT NOT NULL,
    saved TEXT NOT NULL,
    why TEXT NOT NULL, who TEXT NOT NULL DEFAULT '',
    UNIQUE (program, number)
);
INSERT INTO "program_versions" VALUES(1,1,1,X'4739300A58312E32350A4D33300A','52c8a537d108aeef25c2b9272118e16695da373143eae846bfa60f0f215a8605','2026-11-30T08:58:42.877Z','saved','');
CREATE TABLE programs (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    created TEXT NOT NULL
);
INSERT INTO "programs" VALUES(1,'peg.nc','2026-11-30T08:58:42.877Z');
CREATE TABLE row_sums (
    tbl TEXT NOT NULL,
    key NOT NULL,
    sha256 TEXT NOT NULL,
    PRIMARY KEY (tbl, key)
) WITHOUT ROWID;
INSERT INTO "row_sums" VALUES('events',1,'51f29c02c3fe5b18520c48fdf999358e5bc8f22c836927a828b015ad40b0b5d8');
INSERT INTO "row_sums" VALUES('jobs',1,'a61ddfcf71cb2c3a73a0e68f279c23d022950c8696c188459530e398cec5a666');
INSERT INTO "row_sums" VALUES('offset_changes',1,'a51368289e2c513fd7bd62c1f8088387ab41478e78edcf6ebe106b44aa31c1cb');
INSERT INTO "row_sums" VALUES('offset_changes',2,'50669886da9d729f7ccb657e9fdc8154386da64961e6d3f29a0dc6fab0dfc31f');
INSERT INTO "row_sums" VALUES('part_counts','peg.nc','b789bfee301f18bfe10b56676670817e62245976b6f929192a89ae12e4d454e9');
INSERT INTO "row_sums" VALUES('part_cycles',1,'f1f86424cac580c19d4f7096b56667242c9529758a0967ed1debe51323e24296');
INSERT INTO "row_sums" VALUES('part_features',1,'e36c0edce00cbb249ff8d618ad6d9a587f91af70f6fe4d13192229b2b596ab51');
INSERT INTO "row_sums" VALUES('part_readings',1,'1f661c83583e59606468e2032d66c37c3a4557afff6f019d71e7dcfbb8b94982');
INSERT INTO "row_sums" VALUES('people','ANNA','761998e6f9bf0220c7e5cd840090b1dd7b9246c90e907c009e0286314d9e942f');
INSERT INTO "row_sums" VALUES('production_stops',1,'b1b9931210af9eeabe4a3d075edbd003697b3de565682ad09baaceb6c96fb902');
INSERT INTO "row_sums" VALUES('program_versions',1,'51455343da335d3df670996fa85dbcd5dfe3f84276545e33287f78e7bd809516');
INSERT INTO "row_sums" VALUES('programs',1,'7b3fae3c9aec7606fa0cec69bcd1ee0aa16884df9b27cc395b3f43282027d432');
INSERT INTO "row_sums" VALUES('runs','peg.nc','20431ebbf2a0b4ed6e8d2c38b663daf034170dd93354c784d87b33fa40ca5b2f');
INSERT INTO "row_sums" VALUES('settings','theme','35d06b28f5db67383f5e5af1375020a2edc98f6e2686a3c6af08d5f3c5b5c67d');
INSERT INTO "row_sums" VALUES('sqlite_master','','7b385ce01e6aa9efaa36e581d54425c19c6dc03dd5137f656ff320442b2ba8d3');
INSERT INTO "row_sums" VALUES('tool_lives',1,'36791ccdd08592d896b0e4ca96e9c6afa1686502a9091b0c5743e0de03e62c2f');
INSERT INTO "row_sums" VALUES('tool_offsets',1,'80f3d6a6d814981a38b06b7bf20dac0532b72c9d6bfaafc52342fd622298f6b8');
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
INSERT INTO "runs" VALUES('peg.nc','2026-11-30T08:58:42.859Z','',0,NULL,NULL,NULL,'',NULL);
CREATE TABLE secondary_offsets (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    x REAL NOT NULL,
    z REAL NOT NULL,
    r REAL NOT NULL CHECK (r >= 0)
);
CREATE TABLE settings (
    key TEXT PRIMARY KEY,
    value TEXT NOT NULL
);
INSERT INTO "settings" VALUES('theme','"dark"');
CREATE TABLE shared_here (
    program TEXT PRIMARY KEY,
    version TEXT NOT NULL REFERENCES shared_versions (id)
);
CREATE TABLE shared_versions (
    id TEXT PRIMARY KEY,
    program TEXT NOT NULL,
    text TEXT NOT NULL,
    size INTEGER NOT NULL CHECK (size >= 0),
    follows TEXT NOT NULL,
    desk TEXT NOT NULL,
    saved TEXT NOT NULL,
    why TEXT NOT NULL,
    published INTEGER NOT NULL DEFAULT 0 CHECK (published IN (0, 1))
);
CREATE TABLE tool_lives (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 32),
    limit_parts INTEGER NOT NULL DEFAULT 0 CHECK (limit_parts >= 0),
    limit_seconds REAL NOT NULL DEFAULT 0 CHECK (limit_seconds >= 0),
    warn REAL NOT NULL DEFAULT 0.9 CHECK (warn > 0 AND warn <= 1),
    stops INTEGER NOT NULL DEFAULT 0 CHECK (stops IN (0, 1)),
    parts INTEGER NOT NULL DEFAULT 0 CHECK (parts >= 0),
    seconds REAL NOT NULL DEFAULT 0 CHECK (seconds >= 0)
);
INSERT INTO "tool_lives" VALUES(1,50,0.0,0.9,0,0,0.0);
CREATE TABLE "tool_offsets" (
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
INSERT INTO "tool_offsets" VALUES(1,1.25,-0.5,0.0,-0.004,0.0,0,'',0);
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
CREATE TABLE "tool_shapes" (
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
CREATE TABLE zero_offsets (
    code INTEGER PRIMARY KEY CHECK (code BETWEEN 54 AND 59),
    x REAL NOT NULL,
    z REAL NOT NULL,
    c REAL NOT NULL
);
CREATE INDEX offset_changes_by_step ON offset_changes (step);
CREATE INDEX zero_offset_changes_by_step ON zero_offset_changes (step);
CREATE INDEX tool_shape_changes_by_step ON tool_shape_changes (step);
CREATE UNIQUE INDEX part_features_by_name ON part_features (program, name) WHERE retired = 0;
CREATE INDEX part_readings_by_feature ON part_readings (feature);
CREATE INDEX part_cycles_by_program ON part_cycles (program, part);
CREATE UNIQUE INDEX tool_offsets_one_master ON tool_offsets (master) WHERE master = 1;
CREATE INDEX mill_tool_changes_by_step ON mill_tool_changes (step);
CREATE INDEX datum_preset_changes_by_step ON datum_preset_changes (step);
CREATE UNIQUE INDEX one_job_under_way ON jobs ((base IS NOT NULL)) WHERE base IS NOT NULL;
CREATE INDEX program_versions_by_text ON program_versions (sha256);
DELETE FROM "sqlite_sequence";
INSERT INTO "sqlite_sequence" VALUES('part_features',1);
INSERT INTO "sqlite_sequence" VALUES('part_readings',1);
INSERT INTO "sqlite_sequence" VALUES('offset_changes',2);
INSERT INTO "sqlite_sequence" VALUES('part_cycles',1);
INSERT INTO "sqlite_sequence" VALUES('production_stops',1);
INSERT INTO "sqlite_sequence" VALUES('jobs',1);
INSERT INTO "sqlite_sequence" VALUES('events',1);
COMMIT;
