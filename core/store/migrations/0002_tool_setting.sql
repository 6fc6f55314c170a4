-- Wear beside geometry (their sum is the tool's offset), tip quadrant, remark, and at most one master tool.
ALTER TABLE tool_offsets ADD COLUMN wear_x REAL NOT NULL DEFAULT 0;
ALTER TABLE tool_offsets ADD COLUMN wear_z REAL NOT NULL DEFAULT 0;
ALTER TABLE tool_offsets ADD COLUMN quadrant INTEGER NOT NULL DEFAULT 0 CHECK (quadrant BETWEEN 0 AND 9);
ALTER TABLE tool_offsets ADD COLUMN remark TEXT NOT NULL DEFAULT '';
ALTER TABLE tool_offsets ADD COLUMN master INTEGER NOT NULL DEFAULT 0 CHECK (master IN (0, 1));
CREATE UNIQUE INDEX tool_offsets_one_master ON tool_offsets (master) WHERE master = 1;
-- NULL in the rows of secondary offsets, and in those of tools from before this version.
ALTER TABLE offset_changes ADD COLUMN old_wear_x REAL;
ALTER TABLE offset_changes ADD COLUMN old_wear_z REAL;
ALTER TABLE offset_changes ADD COLUMN old_quadrant INTEGER;
ALTER TABLE offset_changes ADD COLUMN old_remark TEXT;
ALTER TABLE offset_changes ADD COLUMN old_master INTEGER;
ALTER TABLE offset_changes ADD COLUMN new_wear_x REAL;
ALTER TABLE offset_changes ADD COLUMN new_wear_z REAL;
ALTER TABLE offset_changes ADD COLUMN new_quadrant INTEGER;
ALTER TABLE offset_changes ADD COLUMN new_remark TEXT;
ALTER TABLE offset_changes ADD COLUMN new_master INTEGER;
