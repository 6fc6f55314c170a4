-- Rotary axes of a preset: where they read 0, degrees in the machine. Changes as those before.
ALTER TABLE datum_presets ADD COLUMN a REAL NOT NULL DEFAULT 0;
ALTER TABLE datum_presets ADD COLUMN b REAL NOT NULL DEFAULT 0;
ALTER TABLE datum_presets ADD COLUMN c REAL NOT NULL DEFAULT 0;
ALTER TABLE datum_preset_changes ADD COLUMN old_a REAL;
ALTER TABLE datum_preset_changes ADD COLUMN old_b REAL;
ALTER TABLE datum_preset_changes ADD COLUMN old_c REAL;
ALTER TABLE datum_preset_changes ADD COLUMN new_a REAL;
ALTER TABLE datum_preset_changes ADD COLUMN new_b REAL;
ALTER TABLE datum_preset_changes ADD COLUMN new_c REAL;
-- Whether another part begins when the life of a mill's tool is gone; what it has made since it was changed.
ALTER TABLE mill_tools ADD COLUMN stops INTEGER NOT NULL DEFAULT 0 CHECK (stops IN (0, 1));
ALTER TABLE mill_tool_changes ADD COLUMN old_stops INTEGER;
ALTER TABLE mill_tool_changes ADD COLUMN new_stops INTEGER;
CREATE TABLE mill_tool_lives (
    number INTEGER PRIMARY KEY CHECK (number BETWEEN 1 AND 999),
    parts INTEGER NOT NULL DEFAULT 0 CHECK (parts >= 0),
    seconds REAL NOT NULL DEFAULT 0 CHECK (seconds >= 0)
);
-- Of which table the tool is: that of the lathes or that of the mills.
ALTER TABLE insert_changes ADD COLUMN kind TEXT NOT NULL DEFAULT 'tool';
