/**
  Post-processor of Fusion (HSM) that writes OmniTurn programs for TurnDesk.

  Fusion runs this file and calls the functions whose names begin with "on". X is a radius in Fusion and a
  diameter (G72) in the program. The post calls error() for everything that it cannot write.
*/

description = "TurnDesk OmniTurn turning";
vendor = "TurnDesk";
legal = "MIT License";
certificationLevel = 2;
minimumRevision = 45702;
longDescription = "Turning post for OmniTurn-style lathes with TurnDesk: turning, threads and drilling on the spindle axis.";
extension = "nc";
setCodePage("ascii");

capabilities = CAPABILITY_TURNING;
tolerance = spatial(0.002, MM);
minimumChordLength = spatial(0.01, MM);
minimumCircularRadius = spatial(0.01, MM);
maximumCircularRadius = spatial(1000, MM);
minimumCircularSweep = toRad(0.01);
maximumCircularSweep = toRad(179); // so that the direction of an arc follows from its points
allowHelicalMoves = false;
allowedCircularPlanes = 1 << PLANE_ZX;

properties = {
  rapidRate: {
    title: "Rapid rate",
    description: "Rapid rate of the first line, in in/min or mm/min. 0 writes 300 in/min.",
    type: "number",
    value: 0,
    scope: "post"
  },
  changeZ: {
    title: "Z of the tool change",
    description: "Z of the tool change in the unit of the program. 0 uses the highest Z of all operations.",
    type: "number",
    value: 0,
    scope: "post"
  },
  writeComments: {
    title: "Write comments",
    description: "Write the names of the operations and the tools as comments.",
    type: "boolean",
    value: true,
    scope: "post"
  }
};

var MAX_TOOL_NUMBER = 32;
var MIN_DWELL_S = 0.1;
var LONGEST_COMMENT = 60;

var comment = ""; // of the next line, because a comment needs a line with a command
var lastX; // radius; undefined while the position is unknown
var lastZ;
var isRapid = false;
var feedWords = "";
var needsBoth = true; // the next move needs X and Z
var activeTool = 0;
var isCoolantOn = false;
var isPerRevolution = false;
var clearZ = 0;
var threadStart; // position before the thread cycle

// --- numbers and lines

function formatNumber(value, places) {
  var text = value.toFixed(places);
  if (text.indexOf(".") >= 0) {
    text = text.replace(/0+$/, "").replace(/\.$/, "");
  }
  if (text === "-0" || text === "") {
    text = "0";
  }
  return text.replace(/^(-?)0\./, "$1.");
}

/** Rounds a length to the resolution of the control: .00005 in on the radius, or four decimals. */
function roundLength(value) {
  return unit === IN ? Math.round(value / 0.00005) * 0.00005 : Math.round(value * 10000) / 10000;
}

function formatWord(letter, value) {
  return letter + formatNumber(letter === "X" ? 2 * roundLength(value) : roundLength(value), 5);
}

/** Writes a line with the comment that waits for it. */
function writeLine(words) {
  var text = getProperty("writeComments") && comment ? "(" + comment + ")" : "";
  comment = "";
  writeln(words + text);
}

/** Sets the comment of the next line, with only the characters that the control accepts. */
function setComment(text) {
  comment = String(text).replace(/[^ -'*-~]/g, " ").substr(0, LONGEST_COMMENT).trim();
}

function checkY(y) {
  if (Math.abs(y) > 1e-6) {
    error("Y is not 0; the path must be in the XZ plane.");
    return false;
  }
  return true;
}

// --- program

function onOpen() {
  var rate = getProperty("rapidRate") || (unit === IN ? 300 : 7620);
  for (var i = 0; i < getNumberOfSections(); ++i) {
    var section = getSection(i);
    clearZ = Math.max(clearZ, section.getInitialPosition().z, section.getGlobalZRange().getMaximum());
  }
  clearZ = getProperty("changeZ") || clearZ;
  if (programComment) {
    setComment(programComment);
  }
  writeLine("G90G94F" + formatNumber(rate, 3) + (unit === IN ? "G70" : "G71") + "G72");
}

function onSection() {
  if (currentSection.getType() !== TYPE_TURNING || currentSection.isMultiAxis()) {
    error("Only turning and drilling on the spindle axis are supported.");
    return;
  }
  if (currentSection.workOffset > 1) {
    error("Only the first work offset is supported; the tool offset T contains the position.");
    return;
  }
  isPerRevolution = currentSection.feedMode === FEED_PER_REVOLUTION;
  if (hasParameter("operation-comment")) {
    setComment(getParameter("operation-comment"));
  }
  if (tool.number !== activeTool) {
    changeTool();
  }
  startSpindle();
  setCoolant(tool.coolant !== COOLANT_OFF);
}

function changeTool() {
  if (tool.number < 1 || tool.number > MAX_TOOL_NUMBER) {
    error("T" + tool.number + " does not exist; use T1 to T" + MAX_TOOL_NUMBER + ".");
    return;
  }
  var operation = comment;
  comment = "";
  retract();
  if (activeTool) {
    writeLine("G97M05"); // G96 must be off when T is written
  }
  activeTool = tool.number;
  setComment(tool.description || operation);
  writeLine("T" + activeTool);
  comment = operation;
  lastX = undefined;
  lastZ = undefined;
  needsBoth = true;
}

function retract() {
  if (activeTool && lastX !== undefined && lastZ < clearZ) {
    moveRapid(lastX, clearZ);
  }
}

function startSpindle() {
  var start = tool.clockwise ? "M03" : "M04";
  if (tool.getSpindleMode() === SPINDLE_CONSTANT_SURFACE_SPEED) {
    var speed = tool.surfaceSpeed * (unit === IN ? 1 / 12 : 1 / 1000); // ft/min or m/min
    if (tool.maximumSpindleSpeed > 0) {
      writeLine("G77S" + formatNumber(tool.maximumSpindleSpeed, 1));
    }
    writeLine("G96" + start + "S" + formatNumber(speed, 3));
  } else if (spindleSpeed > 0) {
    writeLine("G97" + start + "S" + formatNumber(spindleSpeed, 1));
  } else {
    error("The spindle speed is 0; enter it in the operation.");
  }
}

function setCoolant(isOn) {
  if (isOn !== isCoolantOn) {
    writeLine(isOn ? "M08" : "M09");
    isCoolantOn = isOn;
  }
}

function onSectionEnd() {
}

function onClose() {
  retract();
  setCoolant(false);
  writeLine("M05");
  writeLine("M30");
}

// --- moves

function formatPosition(x, z) {
  var words = "";
  if (needsBoth || roundLength(x) !== roundLength(lastX)) {
    words += formatWord("X", x);
  }
  if (needsBoth || roundLength(z) !== roundLength(lastZ)) {
    words += formatWord("Z", z);
  }
  return words;
}

function formatFeed(feed) {
  if (!(feed > 0)) {
    error("The feed is 0; enter the feeds of the operation.");
    return "";
  }
  var words = (isPerRevolution ? "G95F" : "G94F") + formatNumber(feed, isPerRevolution ? 6 : 4);
  if (!isRapid && words === feedWords) {
    return "";
  }
  isRapid = false;
  feedWords = words;
  return words;
}

function moveRapid(x, z) {
  var words = formatPosition(x, z);
  if (words) {
    writeLine((isRapid ? "" : "G00") + words);
    isRapid = true;
    needsBoth = false;
  }
  lastX = x;
  lastZ = z;
}

function moveFeed(x, z, feed, arc, center) {
  if (lastX === undefined || needsBoth) {
    error("The position before this cut is unknown; begin with a rapid in X and Z.");
    return;
  }
  var words = arc ? formatWord("X", x) + formatWord("Z", z) : formatPosition(x, z);
  if (words) {
    writeLine(formatFeed(feed) + (arc || "") + words + (center || ""));
  }
  lastX = x;
  lastZ = z;
}

function onRapid(x, y, z) {
  if (checkY(y)) {
    moveRapid(x, z);
  }
}

function onLinear(x, y, z, feed) {
  if (checkY(y)) {
    moveFeed(x, z, feed);
  }
}

/** Writes an arc. Its direction follows from its points, seen with Z+ to the right and X+ down. */
function onCircular(clockwise, cx, cy, cz, x, y, z, feed) {
  if (getCircularPlane() !== PLANE_ZX || !checkY(y)) {
    error("The arc is not in the XZ plane.");
    return;
  }
  var side = (lastZ - cz) * (x - cx) - (lastX - cx) * (z - cz); // > 0: counterclockwise with X+ up
  var center = formatWord("I", cx - lastX) + formatWord("K", cz - lastZ);
  moveFeed(x, z, feed, side > 0 ? "G02" : "G03", center);
}

function onRapid5D() {
  error("Moves of rotary axes are not supported.");
}

function onLinear5D() {
  error("Moves of rotary axes are not supported.");
}

function onRadiusCompensation() {
  if (radiusCompensation !== RADIUS_COMPENSATION_OFF) {
    error("Select the compensation type In computer; nose compensation of the control is not supported.");
  }
}

function onDwell(seconds) {
  writeLine("G04F" + formatNumber(Math.max(seconds, MIN_DWELL_S), 3));
}

function onSpindleSpeed(speed) {
  writeLine("G97S" + formatNumber(speed, 1));
}

// --- cycles

function onCycle() {
  threadStart = lastX === undefined ? undefined : { x: lastX, z: lastZ };
}

function onCyclePoint(x, y, z) {
  if (cycleType === "thread-turning") {
    writeThread(x, z);
    return;
  }
  if (Math.abs(x) > 1e-6 || !checkY(y)) {
    error("The hole is not on the spindle axis.");
    return;
  }
  switch (cycleType) {
  case "drilling":
    writeHole("G81" + formatWord("Z", cycle.bottom));
    break;
  case "deep-drilling":
  case "chip-breaking":
    if (!(cycle.incrementalDepth > 0)) {
      error("The peck depth is 0; enter the pecking depth.");
      return;
    }
    writeHole("G83" + formatWord("Z", cycle.bottom) + formatWord("K", cycle.incrementalDepth));
    break;
  case "counter-boring":
    approachHole();
    moveFeed(0, cycle.bottom, cycle.feedrate);
    if (cycle.dwell > 0) {
      onDwell(cycle.dwell);
    }
    moveRapid(0, cycle.clearance);
    break;
  default:
    error("The cycle " + cycleType + " is not supported; write it in the editor.");
  }
}

/** Moves to R above the hole; below the clearance plane first in Z, so that the tool does not cross the part. */
function approachHole() {
  if (lastX !== undefined && lastZ < cycle.clearance) {
    moveRapid(lastX, cycle.clearance);
  }
  moveRapid(0, cycle.clearance);
  moveRapid(0, cycle.retract);
}

/** Writes a drilling cycle between its rapids; the cycle ends at its start point. */
function writeHole(words) {
  approachHole();
  writeLine(formatFeed(cycle.feedrate) + words);
  moveRapid(0, cycle.clearance);
}

/** Writes one thread pass: G33 with O from the start point of the cycle, to which the tool returns. */
function writeThread(x, z) {
  if (threadStart === undefined) {
    error("The position before the thread is unknown; begin with a rapid in X and Z.");
    return;
  }
  if (!(cycle.pitch > 0)) {
    error("The pitch of the thread is 0.");
    return;
  }
  if (tool.getSpindleMode() === SPINDLE_CONSTANT_SURFACE_SPEED) {
    error("A thread needs a constant spindle speed.");
    return;
  }
  var taper = cycle.incrementalX || 0;
  var startZ = cycle.incrementalZ ? z - cycle.incrementalZ : threadStart.z;
  moveRapid(threadStart.x, startZ);
  writeLine("G33" + formatWord("X", x - taper) + formatWord("Z", z) +
    "I" + (unit === IN ? ".0001" : ".002") +
    (Math.abs(taper) > 1e-6 ? "A" + formatNumber(2 * roundLength(taper), 5) : "") +
    "K" + formatNumber(cycle.pitch, 8) + "O");
}

function onCycleEnd() {
  threadStart = undefined;
}

// --- functions and comments

function onCommand(command) {
  switch (command) {
  case COMMAND_STOP:
    writeLine("M00");
    break;
  case COMMAND_OPTIONAL_STOP:
    writeLine("M01");
    break;
  case COMMAND_STOP_SPINDLE:
    writeLine("M05");
    break;
  case COMMAND_COOLANT_ON:
    setCoolant(true);
    break;
  case COMMAND_COOLANT_OFF:
    setCoolant(false);
    break;
  case COMMAND_START_SPINDLE:
    startSpindle();
    break;
  case COMMAND_END:
    break;
  default:
    error("The command " + getCommandStringId(command) + " is not supported.");
  }
}

function onComment(text) {
  setComment(text);
}

function onPassThrough(text) {
  error("Lines that the post must pass through are not supported: " + text);
}
