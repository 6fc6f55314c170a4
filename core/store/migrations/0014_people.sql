-- Who works at the machine, by level; of a PIN its salt and its scrypt alone. No row: there are no levels.
CREATE TABLE people (
    name TEXT PRIMARY KEY,
    level INTEGER NOT NULL CHECK (level BETWEEN 1 AND 3),
    salt BLOB NOT NULL,
    hash BLOB NOT NULL
);
-- By whom, where the history did not tell it yet; empty: nobody had said who he is.
ALTER TABLE events ADD COLUMN who TEXT NOT NULL DEFAULT '';
ALTER TABLE program_versions ADD COLUMN who TEXT NOT NULL DEFAULT '';
ALTER TABLE insert_changes ADD COLUMN who TEXT NOT NULL DEFAULT '';
