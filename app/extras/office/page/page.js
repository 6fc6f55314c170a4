"use strict";
// What does not come any more is said: an old figure on a wall is worse than none.
const PICTURES = { part: "part.png", alarm: "alarm.svg" };
const shown = marks(); // what the page came with

function marks() {
  return { ...document.getElementById("drawn").dataset };
}

function show(name, mark) {
  if (shown[name] === mark) return;
  shown[name] = mark;
  const figure = document.getElementById(name);
  figure.hidden = mark === "";
  if (mark !== "") figure.querySelector("img").src = `${PICTURES[name]}?${mark}`;
}

async function look() {
  const lost = document.getElementById("lost");
  try {
    const answer = await fetch("now", { cache: "no-store", signal: AbortSignal.timeout(4000) });
    if (!answer.ok) throw new Error(answer.statusText);
    document.getElementById("now").innerHTML = await answer.text();
    lost.hidden = true;
    const now = marks();
    for (const name in PICTURES) show(name, now[name]);
  } catch {
    lost.hidden = false;
  }
  setTimeout(look, 2000);
}

setTimeout(look, 2000);
