-- An event keeps template and values of its text, so that it can be shown in another language.
ALTER TABLE events ADD COLUMN message TEXT NOT NULL DEFAULT '';
