-- A sum beside every offset, shape, preset, setting, count and tool life: SHA-256 of the row as it was saved.
CREATE TABLE row_sums (
    tbl TEXT NOT NULL,
    key NOT NULL,
    sha256 TEXT NOT NULL,
    PRIMARY KEY (tbl, key)
) WITHOUT ROWID;
