-- Versions of programs that desks share, those of other desks too: id is SHA-256 of the record, text that of the text.
-- follows: the ids that it was made from, between blanks. published 0: it waits for the shared place.
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
-- Which of them this machine has in its program folder, by the program's name in small letters.
CREATE TABLE shared_here (
    program TEXT PRIMARY KEY,
    version TEXT NOT NULL REFERENCES shared_versions (id)
);
CREATE INDEX program_versions_by_text ON program_versions (sha256);
