-- Events, programs, versions, part cycles, production stops and shared versions get a sum too. The sums are made when
-- this version is brought in.
-- Steps of all histories are numbered together, so that they tell the order of changes: a clock may be set back. Of
-- steps that are there already only the time is known; within one history the order stays.
CREATE TEMP TABLE numbered AS
WITH found AS (
    SELECT 'offset' AS log, step, max(at) AS at FROM offset_changes GROUP BY step
    UNION ALL SELECT 'zero', step, max(at) FROM zero_offset_changes GROUP BY step
    UNION ALL SELECT 'shape', step, max(at) FROM tool_shape_changes GROUP BY step
    UNION ALL SELECT 'mill', step, max(at) FROM mill_tool_changes GROUP BY step
    UNION ALL SELECT 'preset', step, max(at) FROM datum_preset_changes GROUP BY step
), forward AS (
    SELECT log, step, max(at) OVER (PARTITION BY log ORDER BY step) AS at FROM found
)
SELECT log, step, row_number() OVER (ORDER BY at, log, step) AS now FROM forward;
CREATE INDEX temp.numbered_by_step ON numbered (log, step);
UPDATE offset_changes SET
    step = (SELECT now FROM numbered WHERE log = 'offset' AND numbered.step = offset_changes.step),
    undoes = iif(undoes IS NULL, NULL, coalesce((SELECT now FROM numbered WHERE log = 'offset' AND numbered.step = offset_changes.undoes), -1));
UPDATE zero_offset_changes SET
    step = (SELECT now FROM numbered WHERE log = 'zero' AND numbered.step = zero_offset_changes.step),
    undoes = iif(undoes IS NULL, NULL, coalesce((SELECT now FROM numbered WHERE log = 'zero' AND numbered.step = zero_offset_changes.undoes), -1));
UPDATE tool_shape_changes SET
    step = (SELECT now FROM numbered WHERE log = 'shape' AND numbered.step = tool_shape_changes.step),
    undoes = iif(undoes IS NULL, NULL, coalesce((SELECT now FROM numbered WHERE log = 'shape' AND numbered.step = tool_shape_changes.undoes), -1));
UPDATE mill_tool_changes SET
    step = (SELECT now FROM numbered WHERE log = 'mill' AND numbered.step = mill_tool_changes.step),
    undoes = iif(undoes IS NULL, NULL, coalesce((SELECT now FROM numbered WHERE log = 'mill' AND numbered.step = mill_tool_changes.undoes), -1));
UPDATE datum_preset_changes SET
    step = (SELECT now FROM numbered WHERE log = 'preset' AND numbered.step = datum_preset_changes.step),
    undoes = iif(undoes IS NULL, NULL, coalesce((SELECT now FROM numbered WHERE log = 'preset' AND numbered.step = datum_preset_changes.undoes), -1));
DROP TABLE numbered;
