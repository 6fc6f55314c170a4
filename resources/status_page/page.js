"use strict";
// What does not come any more is said: an old figure on a wall is worse than none.
const PICTURES = { part: "part.png", alarm: "alarm.svg" };
let looks = 0;

for (const name in PICTURES) {
  const picture = document.getElementById(name);
  picture.addEventListener("error", () => { picture.hidden = true; });
  picture.addEventListener("load", () => { picture.hidden = false; });
  picture.hidden = picture.complete && picture.naturalWidth === 0; // it was not there before we listened
}

async function look() {
  const lost = document.getElementById("lost");
  try {
    const answer = await fetch("now", { cache: "no-store", signal: AbortSignal.timeout(4000) });
    if (!answer.ok) throw new Error(answer.statusText);
    document.getElementById("now").innerHTML = await answer.text();
    lost.hidden = true;
  } catch {
    lost.hidden = false;
  }
  looks += 1;
  if (looks % 15 === 0) {
    for (const name in PICTURES) document.getElementById(name).src = `${PICTURES[name]}?${looks}`;
  }
  setTimeout(look, 2000);
}

setTimeout(look, 2000);
