-- The file of the scope's record of the seconds before an alarm, in the folder records; empty: there is none.
ALTER TABLE events ADD COLUMN record TEXT NOT NULL DEFAULT '';
