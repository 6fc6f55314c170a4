-- The jobs that are to be made, in the order of place. made: parts of it before base; base: the part count of its
-- program when it was put on the desk, NULL while it is not under way. Its parts are made + count - base.
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
CREATE UNIQUE INDEX one_job_under_way ON jobs ((base IS NOT NULL)) WHERE base IS NOT NULL;
