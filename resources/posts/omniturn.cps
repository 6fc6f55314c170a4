/**
  Post-processor of Fusion (HSM) that writes OmniTurn programs for TurnDesk.

  Fusion runs this file and calls the functions whose names begin with "on". X is a radius in Fusion and a
  diameter (G72) in the program. The post calls error() for everything that it cannot write. It is one long
  file, because Fusion imports a post as one file.
*/

description = "TurnDesk OmniTurn turning";
vendor = "TurnDesk";
legal = "MIT License";
certificationLevel = 2;
minimumRevision = 45702;
longDescription = "Turning post for OmniTurn-style lathes with TurnDesk: turning, threads, drilling, taps, and live tools with the C axis.";
extension = "nc";
setCodePage("ascii");

capabilities = CAPABILITY_TURNING | CAPABILITY_MILLING;
tolerance = spatial(0.002, MM);
minimumChordLength = spatial(0.01, MM);
minimumCircularRadius = spatial(0.01, MM);
maximumCircularRadius = spatial(1000, MM);
minimumCircularSweep = toRad(0.01);
maximumCircularSweep = toRad(179); // so that the direction of an arc follows from its points
allowHelicalMoves = false;
allowedCircularPlanes = (1 << PLANE_ZX) | (1 << PLANE_XY);

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
  },
  liveStart: numberProperty("M code that starts the live tools", "Needed for milling and for holes off the axis."),
  liveStop: numberProperty("M code that stops the live tools", "Needed for milling and for holes off the axis."),
  cSpeed: numberProperty("Speed of C", "Speed of the C axis in rpm. 0 uses 60 rpm."),
  workShiftZ: numberProperty("Z from work offset to work offset", "Work offset 2 is at this Z, and 3 at twice this Z."),
  parts: numberProperty("Number of parts", "0 or 1 writes one part; more write a loop."),
  partLength: numberProperty("Length from part to part", "Part, cut-off width and facing stock, for the loop."),
  barStop: numberProperty("Tool of the bar stop", "0 moves the zero along the bar instead of feeding the bar."),
  barFeed: numberProperty("Feed of the bar", "In in/min or mm/min. 0 uses 20 in/min or 500 mm/min."),
  facingStock: numberProperty("Facing stock", "Z of the end of the bar after the bar feed.")
};

function numberProperty(title, description) {
  return { title: title, description: description, type: "number", value: 0, scope: "post" };
}

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
var kind = ""; // of the section: "turning", "face" or "side"
var isLiveRunning = false;
var isLocked = false;
var cAngle; // degrees; undefined while unknown
var isInPlane = false;
var mill; // position of a live tool: x, y and z on the face, x and y on the unrolled side and z as a radius
var sideRadius = 0; // radius at which the tool is clear of the side
var unrolled = 0; // diameter of D in the plane ZC
var shiftZ = 0; // work shift of the active work offset

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

/** Rejects numbers that would turn C or feed the bar in the wrong direction, or start the spindle as a live tool. */
function checkProperties() {
  var positive = ["rapidRate", "changeZ", "cSpeed", "parts", "partLength", "barFeed", "facingStock"];
  for (var i = 0; i < positive.length; ++i) {
    var value = getProperty(positive[i]);
    if (value && !(value > 0 && value <= 1e6)) {
      error("The property " + properties[positive[i]].title + " must be 0 or a positive number.");
    }
  }
  var used = " 1 2 3 4 5 8 9 12 13 19 30 31 89 91 92 93 94 95 96 97 98 99 ";
  var start = getProperty("liveStart");
  var stop = getProperty("liveStop");
  if ((start || stop) && (start === stop || start % 1 !== 0 || stop % 1 !== 0 ||
      used.indexOf(" " + start + " ") >= 0 || used.indexOf(" " + stop + " ") >= 0)) {
    error("The M codes of the live tools must be two whole numbers that the control does not use.");
  }
}

function onOpen() {
  checkProperties();
  var rate = getProperty("rapidRate") || (unit === IN ? 300 : 7620);
  var highestShift = 0;
  for (var i = 0; i < getNumberOfSections(); ++i) {
    var section = getSection(i);
    var start = section.getInitialPosition();
    if (findKind(section) === "side") {
      sideRadius = Math.max(sideRadius, section.isMultiAxis() ? Math.sqrt(start.x * start.x + start.y * start.y) : start.z);
    } else {
      clearZ = Math.max(clearZ, start.z);
    }
    clearZ = Math.max(clearZ, section.getGlobalZRange().getMaximum());
    highestShift = Math.max(highestShift, (Math.max(section.workOffset, 1) - 1) * getProperty("workShiftZ"));
  }
  clearZ = getProperty("changeZ") || clearZ + highestShift;
  if (programComment) {
    setComment(programComment);
  }
  if (getProperty("parts") > 1 && getProperty("barStop") && clearZ <= getProperty("facingStock")) {
    error("The Z of the tool change must be in front of the facing stock.");
  }
  writeLine("G90G94F" + formatNumber(rate, 3) + (unit === IN ? "G70" : "G71") + "G72");
  writeLoop();
}

/** Writes the loop for several parts; the part itself becomes subroutine 1. */
function writeLoop() {
  var length = getProperty("partLength");
  var end = getProperty("facingStock") - length;
  if (getProperty("parts") <= 1) {
    return;
  }
  if (!(length > 0) || end >= 0 || getProperty("parts") % 1 !== 0) {
    error("Enter a whole number of parts, and a length from part to part greater than the facing stock.");
    return;
  }
  writeLine("LS" + getProperty("parts"));
  if (getProperty("barStop")) {
    checkTool(getProperty("barStop"));
    writeLine("M05");
    writeLine("T" + getProperty("barStop"));
    writeLine("G00X0" + formatWord("Z", clearZ));
    writeLine("G00" + formatWord("Z", end));
    writeLine("M13");
    writeLine("G94F" + formatNumber(getProperty("barFeed") || (unit === IN ? 20 : 500), 3) +
      formatWord("Z", getProperty("facingStock")));
    writeLine("M12");
    writeLine("G00" + formatWord("Z", clearZ));
    writeLine("P1");
  } else {
    writeLine("P1");
    writeLine("G10X0" + formatWord("Z", -length));
  }
  writeLine("LF");
  writeLine("M30");
  writeLine("}1");
}

/** Returns "turning", "face" or "side", or an empty string for a section that is not supported. */
function findKind(section) {
  var forward = section.workPlane.forward;
  if (section.getType() === TYPE_TURNING) {
    return section.isMultiAxis() ? "" : "turning";
  }
  if (section.isMultiAxis() || Math.abs(forward.z) < 1e-6) {
    return "side";
  }
  if (forward.z < 1 - 1e-6) {
    return "";
  }
  var start = section.getInitialPosition();
  var isLive = !section.getTool().isLiveTool || section.getTool().isLiveTool();
  var isDrill = section.hasParameter("operation-strategy") && section.getParameter("operation-strategy") === "drill";
  var isCentered = Math.abs(start.x) < 1e-6 && Math.abs(start.y) < 1e-6 && section.getNumberOfCyclePoints() === 1;
  return isDrill && isCentered && !isLive ? "turning" : "face";
}

function onSection() {
  var before = kind;
  kind = findKind(currentSection);
  if (!kind) {
    error("Tools that are tilted against the X and Z axes are not supported.");
    return;
  }
  isPerRevolution = currentSection.feedMode === FEED_PER_REVOLUTION;
  if (hasParameter("operation-comment")) {
    setComment(getParameter("operation-comment"));
  }
  var isNewKind = (kind === "turning") !== (before === "turning");
  if (tool.number !== activeTool || (before && isNewKind) || currentSection.workOffset > 1 || shiftZ) {
    changeTool();
  }
  if (kind === "turning") {
    startSpindle();
  } else {
    startLiveTool();
  }
  mill = undefined;
  setCoolant(tool.coolant !== COOLANT_OFF);
}

function checkTool(number) {
  if (!(number >= 1 && number <= MAX_TOOL_NUMBER && number % 1 === 0)) {
    error("T" + number + " does not exist; use T1 to T" + MAX_TOOL_NUMBER + ".");
  }
}

/** Writes G10 if the work offset changes; G10 adds to the active work shift, and applies from the next T. */
function shiftZero() {
  var number = Math.max(currentSection.workOffset, 1) - 1;
  if (number && !getProperty("workShiftZ")) {
    error("The position of work offset " + (number + 1) + " is unknown; enter the property Z from work offset to work offset.");
    return;
  }
  var shift = number * getProperty("workShiftZ");
  if (roundLength(shift - shiftZ) !== 0) {
    writeLine("G10X0" + formatWord("Z", shift - shiftZ));
  }
  shiftZ = shift;
}

function changeTool() {
  checkTool(tool.number);
  var operation = comment;
  comment = "";
  retract();
  stopLiveTool();
  if (activeTool && !isLocked) {
    writeLine("G97M05"); // G96 must be off when T is written
  }
  if (kind !== "turning") {
    if (isLocked || !activeTool) {
      writeLine("M05");
    }
    lockSpindle();
  } else if (isLocked) {
    writeLine("M05");
    isLocked = false;
  }
  shiftZero();
  activeTool = tool.number;
  setComment(tool.description || operation);
  writeLine("T" + activeTool);
  comment = operation;
  lastX = undefined;
  lastZ = undefined;
  needsBoth = true;
  forgetModes();
}

/** Writes G00 or the feed again on the next move. */
function forgetModes() {
  isRapid = false;
  feedWords = "";
}

function getClearZ() {
  return clearZ - shiftZ;
}

function retract() {
  leavePlane();
  if (activeTool && lastX !== undefined && lastZ < getClearZ()) {
    moveRapid(lastX, getClearZ());
  }
}

// --- live tools

function getCSpeed() {
  return getProperty("cSpeed") || 60;
}

/** Writes M19, which turns C to 0 by at most one revolution, and a dwell for this time. */
function lockSpindle() {
  writeLine("M19S" + formatNumber(getCSpeed(), 1));
  onDwell(Math.ceil(600 / getCSpeed()) / 10 + 0.5);
  isLocked = true;
  cAngle = 0;
  forgetModes();
}

/** Writes the shortest rotation of C, and a dwell for this time. The resolution of C is 0.02 degrees. */
function rotate(angle) {
  if (cAngle === undefined) {
    lockSpindle();
  }
  var goal = Math.round(angle / 0.02) * 0.02;
  goal += 360 * Math.round((cAngle - goal) / 360);
  var turn = Math.abs(goal - cAngle);
  if (turn > 0.01) {
    writeLine("CA" + formatNumber(goal, 2) + "S" + formatNumber(getCSpeed(), 1));
    onDwell(Math.ceil(turn / (0.6 * getCSpeed())) / 10 + 0.5);
    cAngle = goal;
    forgetModes();
  }
}

function startLiveTool() {
  var start = getProperty("liveStart");
  if (!(start >= 1 && start <= 99 && getProperty("liveStop") >= 1 && getProperty("liveStop") <= 99)) {
    error("Enter the M codes that start and stop the live tools in the properties.");
    return;
  }
  if (!(spindleSpeed > 0) || !tool.clockwise) {
    error("A live tool needs a speed and turns only clockwise.");
    return;
  }
  if (!isLiveRunning) {
    setComment("LIVE TOOL " + formatNumber(spindleSpeed, 1) + " RPM");
    writeLine("M" + ("0" + start).slice(-2));
    isLiveRunning = true;
  }
}

function stopLiveTool() {
  if (isLiveRunning) {
    writeLine("M" + ("0" + getProperty("liveStop")).slice(-2));
    isLiveRunning = false;
  }
}

/** Returns a point of the work plane in the coordinates of the part. */
function toPart(x, y, z) {
  var plane = currentSection.workPlane;
  return {
    x: x * plane.right.x + y * plane.up.x + z * plane.forward.x,
    y: x * plane.right.y + y * plane.up.y + z * plane.forward.y,
    z: x * plane.right.z + y * plane.up.z + z * plane.forward.z
  };
}

/** Returns the position of the tool on the unrolled side; the tool must point at the spindle axis. */
function toSide(x, y, z, axis) {
  var length = Math.sqrt(axis.x * axis.x + axis.y * axis.y);
  if (Math.abs(axis.z) > 1e-6 || Math.abs(x * axis.y - y * axis.x) > 1e-4 * length) {
    error("The tool on the side does not point at the spindle axis.");
  }
  var angle = Math.atan2(axis.y, axis.x);
  if (mill) {
    angle += 2 * Math.PI * Math.round((mill.angle - angle) / (2 * Math.PI));
  }
  return { x: -z, y: angle * unrolled / 2, z: (x * axis.x + y * axis.y) / length, angle: angle };
}

function getClearHeight() {
  return kind === "side" ? sideRadius : getClearZ();
}

/** Writes the approach, C0 and the start of the plane, and moves above the point. */
function enterPlane(at) {
  var radius = Math.sqrt(at.x * at.x + at.y * at.y);
  if (kind === "side") {
    approachSide(0);
  } else {
    moveRapid(-Math.max(radius, unit === IN ? 0.04 : 1), getClearZ());
  }
  if (cAngle !== 0) {
    lockSpindle();
  }
  writeLine("G94F" + formatNumber(getPlaneRapid(), 4));
  comment = "";
  forgetModes();
  isInPlane = true;
  writeln(kind === "side" ? "(~PLZC)" : "(~PLXC)");
  if (kind === "side") {
    writeln("(D" + formatNumber(roundLength(unrolled), 5) + ")");
  } else if (radius >= (unit === IN ? 0.04 : 1) && Math.abs(at.y) + Math.abs(at.x - radius) > 1e-6) {
    // around the axis, because a line could pass through it
    writeln("(" + (at.y >= 0 ? "G03" : "G02") + formatPlane("X", at.x) + formatPlane("Y", at.y) + "I0J0F" +
      formatNumber(getPlaneRapid(), 4) + ")");
  }
  writePlaneMove({ x: at.x, y: at.y, z: getClearHeight() }, getPlaneRapid());
  if (Math.abs(at.z - getClearHeight()) > 1e-6) {
    writePlaneMove(at, getPlaneRapid());
  }
}

/** Writes the retract to the clear height and the end of the plane; the position is then unknown. */
function leavePlane() {
  if (!isInPlane) {
    return;
  }
  if (mill.z < getClearHeight()) {
    writePlaneMove({ x: mill.x, y: mill.y, z: getClearHeight() }, getPlaneRapid());
  }
  writeln("(END)");
  isInPlane = false;
  cAngle = undefined;
  needsBoth = true;
  lastX = kind === "side" ? -sideRadius : -Math.sqrt(mill.x * mill.x + mill.y * mill.y);
  lastZ = kind === "side" ? -mill.x : Math.max(mill.z, getClearZ());
  mill = undefined;
}

/** Returns the feed instead of a rapid, because a plane has no rapid: 50 in/min. */
function getPlaneRapid() {
  return unit === IN ? 50 : 1270;
}

/** Formats a word of a plane; X is not a diameter there. */
function formatPlane(letter, value) {
  return letter + formatNumber(roundLength(value), 5);
}

function writePlaneMove(at, feed) {
  writeln("(" + formatPlane("X", at.x) + formatPlane("Y", at.y) +
    (kind === "side" ? "Z" + formatNumber(2 * roundLength(at.z), 5) : formatPlane("Z", at.z)) +
    "F" + formatNumber(feed, 4) + ")");
}

/** Moves a live tool; feed is undefined for a rapid, which begins outside the plane. */
function moveMill(at, feed) {
  if (feed !== undefined || isInPlane) {
    if (!mill) {
      error("The position before this cut is unknown; begin with a rapid.");
      return;
    }
    if (!isInPlane) {
      enterPlane(mill);
    }
    writePlaneMove(at, feed === undefined ? getPlaneRapid() : toPerMinute(feed));
  }
  mill = at;
}

function toPerMinute(feed) {
  if (!(feed > 0)) {
    error("The feed is 0; enter the feeds of the operation.");
  }
  return isPerRevolution ? feed * spindleSpeed : feed;
}

/** Moves out in X and then in Z, so that the tool is above a point of the side. */
function approachSide(z) {
  moveRapid(-sideRadius, lastZ === undefined ? getClearZ() : lastZ);
  moveRapid(-sideRadius, z);
}

/** Writes a hole of a live tool: C turns it under the tool. */
function writeLiveHole(x, y, bottom) {
  var at = toPart(x, y, bottom);
  var feed = toPerMinute(cycle.feedrate);
  var peck = cycleType === "drilling" || cycleType === "counter-boring" ? Infinity : cycle.incrementalDepth;
  if (!(peck > 0) || !(cycle.retract > bottom)) {
    error("The peck depth is 0, or the bottom of the hole is not below the retract height.");
    return;
  }
  leavePlane();
  if (kind === "side") {
    var axis = currentSection.workPlane.forward;
    sideRadius = Math.max(sideRadius, cycle.clearance);
    toSide(at.x, at.y, at.z, axis);
    if (bottom < 0) {
      error("The hole is deeper than the spindle axis.");
      return;
    }
    approachSide(at.z);
    rotate(-toDeg(Math.atan2(axis.y, axis.x)));
    writePecks(function (height) { return { x: -height, z: at.z }; }, bottom, peck, feed);
    moveRapid(-sideRadius, at.z);
  } else {
    var radius = Math.sqrt(at.x * at.x + at.y * at.y);
    moveRapid(-radius, getClearZ());
    rotate(-toDeg(Math.atan2(at.y, at.x)));
    writePecks(function (height) { return { x: -radius, z: height }; }, bottom, peck, feed);
    moveRapid(-radius, getClearZ());
  }
}

/** Writes a hole as single moves from the retract height; place() returns X and Z at a height. */
function writePecks(place, bottom, peck, feed) {
  var top = place(cycle.retract);
  var margin = unit === IN ? 0.02 : 0.5;
  var isPerRev = isPerRevolution;
  isPerRevolution = false; // feed is per minute
  moveRapid(top.x, top.z);
  for (var depth = cycle.retract; depth > bottom + 1e-6;) {
    if (depth < cycle.retract) {
      var above = place(Math.min(depth + margin, cycle.retract));
      moveRapid(above.x, above.z);
    }
    depth = Math.max(depth - peck, bottom);
    var end = place(depth);
    moveFeed(end.x, end.z, feed);
    if (depth <= bottom && cycleType === "counter-boring" && cycle.dwell > 0) {
      onDwell(cycle.dwell);
    }
    moveRapid(top.x, top.z);
  }
  isPerRevolution = isPerRev;
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
  leavePlane();
}

function onClose() {
  retract();
  stopLiveTool();
  setCoolant(false);
  writeLine("M05");
  if (getProperty("parts") > 1) {
    if (shiftZ) {
      writeLine("G10X0" + formatWord("Z", -shiftZ));
    }
    writeLine("M99");
  } else {
    writeLine("M30");
  }
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
  if (needsBoth && z < getClearZ() && (getProperty("workShiftZ") || (lastX === undefined && z < 0))) {
    // the line from an unknown position could cross a part
    writeLine("G00" + formatWord("X", x) + formatWord("Z", getClearZ()));
    isRapid = true;
    needsBoth = false;
    lastX = x;
    lastZ = getClearZ();
  }
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
  if (kind === "face") {
    moveMill(toPart(x, y, z));
  } else if (kind === "side") {
    error("Milling on the side needs a multi-axis operation that wraps the path around the spindle axis.");
  } else if (checkY(y)) {
    moveRapid(x, z);
  }
}

function onLinear(x, y, z, feed) {
  if (kind === "face") {
    moveMill(toPart(x, y, z), feed);
  } else if (kind === "side") {
    error("Milling on the side needs a multi-axis operation that wraps the path around the spindle axis.");
  } else if (checkY(y)) {
    moveFeed(x, z, feed);
  }
}

/** Writes an arc. Its direction follows from its points, seen with Z+ to the right and X+ down. */
function onCircular(clockwise, cx, cy, cz, x, y, z, feed) {
  if (kind === "face") {
    millArc(toPart(cx, cy, cz), toPart(x, y, z), feed);
    return;
  }
  if (getCircularPlane() !== PLANE_ZX || !checkY(y)) {
    error("The arc is not in the XZ plane.");
    return;
  }
  if (roundLength(x) === roundLength(lastX) && roundLength(z) === roundLength(lastZ)) {
    return; // the control would cut a full circle
  }
  var side = (lastZ - cz) * (x - cx) - (lastX - cx) * (z - cz); // > 0: counterclockwise with X+ up
  var center = formatWord("I", cx - lastX) + formatWord("K", cz - lastZ);
  moveFeed(x, z, feed, side > 0 ? "G02" : "G03", center);
}

function millArc(center, end, feed) {
  if (getCircularPlane() !== PLANE_XY || !mill || Math.abs(end.z - mill.z) > 1e-6) {
    error("The arc is not in the XY plane, or the position before it is unknown.");
    return;
  }
  if (!isInPlane) {
    enterPlane(mill);
  }
  if (roundLength(end.x) === roundLength(mill.x) && roundLength(end.y) === roundLength(mill.y)) {
    mill = end;
    return; // the control would cut a full circle
  }
  var side = (mill.x - center.x) * (end.y - center.y) - (mill.y - center.y) * (end.x - center.x);
  writeln("(" + (side > 0 ? "G03" : "G02") + formatPlane("X", end.x) + formatPlane("Y", end.y) +
    formatPlane("I", center.x) + formatPlane("J", center.y) + "F" + formatNumber(toPerMinute(feed), 4) + ")");
  mill = end;
}

/** Moves a tool on the side; a, b and c are the direction of its axis. */
function moveOnSide(x, y, z, a, b, c, feed) {
  if (kind !== "side") {
    error("Moves of rotary axes are supported only on the side of the part.");
    return;
  }
  if (!mill && !isInPlane) {
    unrolled = 2 * sideRadius;
  }
  moveMill(toSide(x, y, z, { x: a, y: b, z: c }), feed);
}

function onRapid5D(x, y, z, a, b, c) {
  moveOnSide(x, y, z, a, b, c);
}

function onLinear5D(x, y, z, a, b, c, feed) {
  moveOnSide(x, y, z, a, b, c, feed);
}

function onRadiusCompensation() {
  if (radiusCompensation !== RADIUS_COMPENSATION_OFF) {
    error("Select the compensation type In computer; nose compensation of the control is not supported.");
  }
}

function onDwell(seconds) {
  if (isInPlane) {
    error("A dwell is not possible in the plane of a live tool.");
    return;
  }
  writeLine("G04F" + formatNumber(Math.max(seconds, MIN_DWELL_S), 3));
}

function onSpindleSpeed(speed) {
  if (kind !== "turning") {
    error("The speed of a live tool must not change in the operation.");
    return;
  }
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
  if (kind !== "turning") {
    if (cycleType.indexOf("tapping") >= 0) {
      error("A live tool cannot tap, because it has one direction.");
    } else if (/^(drilling|deep-drilling|chip-breaking|counter-boring)$/.test(cycleType)) {
      writeLiveHole(x, y, cycle.bottom);
    } else {
      error("The cycle " + cycleType + " is not supported; write it in the editor.");
    }
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
  case "tapping":
  case "right-tapping":
  case "left-tapping":
    writeTap();
    break;
  default:
    error("The cycle " + cycleType + " is not supported; write it in the editor.");
  }
}

/** Writes a tap in a floating holder: feed in at the pitch, reverse, and feed out. */
function writeTap() {
  var isLeft = cycleType === "left-tapping" || (cycleType === "tapping" && tool.type === TOOL_TAP_LEFT_HAND);
  if (!(tool.threadPitch > 0) || tool.threadPitch > (unit === IN ? 0.2 : 5.08)) {
    error("The pitch of the tap is unknown or more than .2 in; enter it in the tool.");
    return;
  }
  if (tool.clockwise === isLeft || tool.getSpindleMode() === SPINDLE_CONSTANT_SURFACE_SPEED) {
    error("The tap needs a constant spindle speed in the direction of its thread.");
    return;
  }
  approachHole();
  var feed = "G95F" + formatNumber(tool.threadPitch, 6);
  writeLine(feed + formatWord("Z", cycle.bottom));
  writeLine(isLeft ? "M03" : "M04");
  onDwell(Math.max(cycle.dwell || 0, 0.5));
  writeLine(feed + formatWord("Z", cycle.retract));
  lastZ = cycle.retract;
  forgetModes();
  startSpindle();
  moveRapid(0, cycle.clearance);
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
  leavePlane();
  switch (command) {
  case COMMAND_STOP:
    writeLine("M00");
    break;
  case COMMAND_OPTIONAL_STOP:
    writeLine("M01");
    break;
  case COMMAND_STOP_SPINDLE:
    if (kind === "turning") {
      writeLine("M05");
    } else {
      retract();
      stopLiveTool();
    }
    break;
  case COMMAND_COOLANT_ON:
    setCoolant(true);
    break;
  case COMMAND_COOLANT_OFF:
    setCoolant(false);
    break;
  case COMMAND_START_SPINDLE:
    if (kind === "turning") {
      startSpindle();
    } else {
      startLiveTool();
    }
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
