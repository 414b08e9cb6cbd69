// The camera in the page: video.mjs BROWSER VIEW_URL tip|step|jpeg|stops OUT, or, of what it read,
// video.mjs --compare OUT TICKS.csv NAME. PALP_SHOTS: a folder for pictures.
import { readFileSync } from 'node:fs';
import { Browser, finish, pause } from './browser.mjs';

const WHOLE_BALL = 0.96 * Math.PI * 40 ** 2;  // pixels
const NOTICED_MS = 15;  // Di Luca and Mahnan 2019
const must = (holds, what) => { if (!holds) throw new Error(what); };
const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

// A copy is read: reading back would change how the page's own canvas is drawn.
const READER = `(canvas, top, height) => {
  const copy = new OffscreenCanvas(canvas.width, height), to = copy.getContext('2d', { willReadFrequently: true });
  to.drawImage(canvas, 0, -top);
  return to.getImageData(0, 0, canvas.width, height).data;
}`;

// The ball alone is blue; 8 pixels are 1 mm, the picture's corner lies at -40 and -20 mm.
const READ_TIP = `(() => {
  const canvas = document.getElementById('picture'), { shown } = window.palpPicture();
  if (!canvas || !shown) return null;
  const { width, height } = canvas, data = (${READER})(canvas, 0, height);
  let count = 0, across = 0, down = 0;
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) {
    const i = 4 * (y * width + x);
    if (data[i + 2] < data[i] + 50 || data[i + 2] < data[i + 1] + 40) continue;
    count++; across += x + 0.5; down += y + 0.5;
  }
  if (count < 400) return { stamp: shown.stamp, count };
  return { stamp: shown.stamp, count, x: across / count / 8 - 40, depth: down / count / 8 - 20 + 5 };
})()`;

/** Pictures while the hand works, the tip in each, and how old each was when it was drawn. */
async function readTips(page, result) {
  await page.until('window.palpPicture().shown', 'a picture', 30000);
  await pause(3000);
  const tips = new Map();
  await page.eval('window.palpPicture().drawn.length = 0');
  for (const end = Date.now() + 12000; Date.now() < end; await pause(100)) {
    const tip = await page.eval(READ_TIP);
    if (tip) tips.set(tip.stamp, tip);
  }
  result.tips = [...tips.values()];
  const { drawn, video, resets, behind } = await page.eval('window.palpPicture()');
  Object.assign(result, { drawn, video, resets, behind, way: await page.eval('window.palpWay()') });
  result.words = await page.text('camera');
}

/** Pictures that touch waits for: how far they are behind it. */
async function readStep(page, result) {
  await page.until('window.palpPicture().video?.touch_held_ms > 0', 'touch that waits', 30000);
  await pause(8000);
  const apart = [];
  for (const end = Date.now() + 12000; Date.now() < end; await pause(90)) apart.push(await page.eval('window.palpPicture().behind'));
  const sizes = apart.map(Math.abs), held = await page.eval('window.palpPicture().video.touch_held_ms');
  result.said = `touch waits for ${held.toFixed(1)} ms, pictures ${quantile(apart, 0.5).toFixed(1)} ms behind it (p50; 95 % within ${quantile(sizes, 0.95).toFixed(1)} ms)`;
  must(Math.abs(quantile(apart, 0.5)) < 5, result.said);
  must(quantile(sizes, 0.95) < NOTICED_MS, result.said);
  must(/in step/.test(await page.text('camera')), `the page says "${await page.text('camera')}"`);
}

async function readJpeg(page, result) {
  await page.until('window.palpPicture().shown', 'a picture', 30000);
  const white = () => page.eval(`(() => { const c = document.getElementById('picture');
    const data = (${READER})(c, 420, 1);
    let sum = 0, count = 0;
    for (let x = 0; x < c.width; x++) if (data[4 * x] > 180) { sum += x; count++; }
    return count ? sum / count : -1; })()`);
  const before = await white();
  must(before >= 0, 'no white block in the test picture');
  await pause(1500);
  must(Math.abs(await white() - before) > 5, 'the block in the test picture does not move');
}

async function readStop(page, result) {
  await page.until('/carries force only/.test(document.getElementById("camera").innerText)', 'the sentence that video stopped', 40000);
  result.said = await page.text('no-picture');
  must(await page.eval('document.querySelector(".link header").innerText.includes("live")'), 'force stopped too');
}

function compare(read, csv, name) {
  const { tips, drawn, way, video, resets } = JSON.parse(readFileSync(read, 'utf8'));
  const [head, ...rows] = readFileSync(csv, 'utf8').trim().split('\n');
  const names = head.split(','), at = n => names.indexOf(n);
  const log = rows.map(row => row.split(',')).map(r => ({ t: Number(BigInt(r[at('stamp_ns')]) / 1000n) / 1e3, x: r[at('x_m')] * 1e3, depth: r[at('position_m')] * 1e3 }));
  // Of a ball that hangs out of the picture the middle is another.
  const seen = tips.filter(tip => tip.depth !== undefined && tip.count > WHOLE_BALL);
  const errors = seen.map(tip => Math.min(...log.filter(l => Math.abs(l.t - tip.stamp) <= 34).map(l => Math.hypot(l.x - tip.x, l.depth - tip.depth))));
  const moved = Math.max(...seen.map(t => t.depth)) - Math.min(...seen.map(t => t.depth));
  const added = drawn.map(age => age - way), frames = video.delivered + video.not_shown;
  console.log(`video, ${name}: ${seen.length} pictures over ${moved.toFixed(1)} mm of depth, tip off by p50 ${quantile(errors, 0.5).toFixed(2)}, most ${Math.max(...errors).toFixed(2)} mm; `
    + `capture to canvas less ${way.toFixed(1)} ms of line p50 ${quantile(added, 0.5).toFixed(1)}, p95 ${quantile(added, 0.95).toFixed(1)} ms; `
    + `${(100 * video.delivered / frames).toFixed(1)} % of ${frames} shown, ${video.repaired} repaired, decoder begun anew ${resets} times`);
  must(seen.length >= 40, `only ${seen.length} of ${tips.length} pictures show the tip`);
  must(moved > 3, `the tip moved by ${moved.toFixed(1)} mm only`);
  must(Math.max(...errors) <= 0.3, `the tip in the picture is ${Math.max(...errors).toFixed(2)} mm off the log`);
}

if (process.argv[2] === '--compare') {
  try { compare(...process.argv.slice(3)); } catch (error) { console.log(error.message); process.exit(1); }
  process.exit(0);
}
const [program, url, kind, out] = process.argv.slice(2);
const browser = await Browser.start(program), result = {};
try {
  const page = await browser.open(url);
  await { tip: readTips, step: readStep, jpeg: readJpeg, stops: readStop }[kind](page, result);
  if (process.env.PALP_SHOTS) await page.picture(`${process.env.PALP_SHOTS}/video-${kind}.png`);
  must(page.errors.length === 0, `the page wrote: ${page.errors.join('; ')}`);
} catch (error) {
  result.fault = error.message;
} finally {
  await finish(browser, out, result);
}
