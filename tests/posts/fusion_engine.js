// A replacement of the engine with which Fusion runs a post: node fusion_engine.js POST JOB.json
// The job has a unit, properties and sections with a tool and a list of calls. The program goes to stdout;
// the first error() of the post goes to stderr, with exit status 1.
"use strict";
const fs = require("fs");
const vm = require("vm");

const [post, jobFile] = process.argv.slice(2);
const job = JSON.parse(fs.readFileSync(jobFile, "utf8"));
const lines = [];

class PostError extends Error {}

const names = [
  "MM IN PLANE_XY PLANE_ZX PLANE_YZ CAPABILITY_TURNING CAPABILITY_MILLING TYPE_TURNING TYPE_MILLING",
  "FEED_PER_MINUTE FEED_PER_REVOLUTION SPINDLE_CONSTANT_SURFACE_SPEED SPINDLE_CONSTANT_SPINDLE_SPEED",
  "COOLANT_OFF COOLANT_FLOOD COOLANT_MIST RADIUS_COMPENSATION_OFF RADIUS_COMPENSATION_LEFT COMMAND_STOP",
  "COMMAND_OPTIONAL_STOP COMMAND_STOP_SPINDLE COMMAND_COOLANT_ON COMMAND_COOLANT_OFF COMMAND_START_SPINDLE",
  "COMMAND_END COMMAND_TOOL_MEASURE TOOL_TAP_RIGHT_HAND TOOL_TAP_LEFT_HAND",
].join(" ").split(" ");
const context = { console, Math };
names.forEach((name, index) => { context[name] = index; });
const named = (name) => context[name];

context.unit = named(job.unit);
context.programComment = job.comment || "";
context.setCodePage = () => {};
context.toRad = (degrees) => (degrees * Math.PI) / 180;
context.toDeg = (radians) => (radians * 180) / Math.PI;
context.spatial = (value, unit) => (unit === context.unit ? value : unit === named("MM") ? value / 25.4 : value * 25.4);
context.writeln = (text) => lines.push(text);
context.error = (text) => { throw new PostError(text); };
context.getProperty = (name) => (name in (job.properties || {}) ? job.properties[name] : context.properties[name].value);
context.getNumberOfSections = () => job.sections.length;
context.getSection = (index) => makeSection(job.sections[index]);
context.hasParameter = (name) => name in (current.parameters || {});
context.getParameter = (name) => current.parameters[name];
context.getCircularPlane = () => named(current.plane || "PLANE_ZX");
context.getCommandStringId = (command) => names[command];

let current = {};

const vector = ([x, y, z]) => ({ x, y, z });

function makeSection(section) {
  const [right, up, forward] = section.workPlane || [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const [x, z, y] = [...section.start, 0];
  return {
    workPlane: { right: vector(right), up: vector(up), forward: vector(forward) },
    getTool: () => ({ isLiveTool: () => Boolean(section.tool.live) }),
    hasParameter: (name) => name in (section.parameters || {}),
    getParameter: (name) => section.parameters[name],
    getNumberOfCyclePoints: () => section.calls.filter(([name]) => name === "onCyclePoint").length,
    getType: () => named(section.type || "TYPE_TURNING"),
    isMultiAxis: () => Boolean(section.multiAxis),
    workOffset: section.workOffset || 0,
    feedMode: named(section.feedMode || "FEED_PER_REVOLUTION"),
    getInitialPosition: () => ({ x, y, z }),
    getGlobalZRange: () => ({ getMaximum: () => section.top ?? section.start[1], getMinimum: () => -1 }),
  };
}

function makeTool(tool) {
  const isSurface = tool.surfaceSpeed !== undefined;
  return {
    clockwise: true,
    description: "",
    ...tool,
    type: named(tool.type),
    coolant: named(tool.coolant || "COOLANT_OFF"),
    getSpindleMode: () => named(isSurface ? "SPINDLE_CONSTANT_SURFACE_SPEED" : "SPINDLE_CONSTANT_SPINDLE_SPEED"),
  };
}

function run() {
  vm.createContext(context);
  vm.runInContext(fs.readFileSync(post, "utf8"), context, { filename: post });
  context.onOpen();
  for (const section of job.sections) {
    current = section;
    context.currentSection = makeSection(section);
    context.tool = makeTool(section.tool);
    context.spindleSpeed = section.tool.spindleRPM || 0;
    context.onSection();
    for (const [name, ...values] of section.calls) {
      if (name === "cycle") {
        [context.cycleType, context.cycle] = values;
        context.onCycle();
      } else if (name === "radiusCompensation") {
        context.radiusCompensation = named(values[0]);
        context.onRadiusCompensation();
      } else {
        context[name](...(name === "onCommand" ? values.map(named) : values));
      }
    }
    context.onSectionEnd();
  }
  context.onClose();
}

try {
  run();
  process.stdout.write(lines.map((line) => `${line}\n`).join(""));
} catch (error) {
  if (!(error instanceof PostError)) {
    throw error;
  }
  process.stderr.write(error.message);
  process.exitCode = 1;
}
