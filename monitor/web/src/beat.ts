// One beat for all that moves. Without a GPU each change that comes alone costs the browser a whole
// frame. So what is due is drawn together: with a picture or, where none comes, by a timer. No
// animation frames: asking for them makes such a browser make all 60 a second.
const ALONE_MS = 50, LOOK_MS = 25, EARLY_MS = 8;

interface Part { every: number; drawn: number; draw: () => void }
const parts = new Set<Part>();
let last = 0;

/** Draws what is due at that page time [ms]. */
export function beat(now: number): void {
  last = now;
  for (const part of parts) {
    if (now - part.drawn < part.every - EARLY_MS) continue;
    part.drawn = now;
    part.draw();
  }
}

/** Has `draw` called about every so many [ms] while the page is seen; what it returns ends that. */
export function onBeat(every: number, draw: () => void): () => void {
  const part = { every, drawn: 0, draw };
  parts.add(part);
  return () => { parts.delete(part); };
}

setInterval(() => {
  const now = performance.now();
  if (!document.hidden && now - last > ALONE_MS - LOOK_MS / 2) beat(now);
}, LOOK_MS);
