// The camera's frames onto a canvas: by WebCodecs, or as JPEG. Never a wrong picture: after what
// cannot be decoded, or came too late, only a key frame begins anew, and is asked for.

/** What a decoder may have waiting: frames, and [ms] of age beyond the newest shown. */
const WAITING_MAX = 4, WAITING_AGE_MS = 150;
const ASK_AGAIN_MS = 2500;
/** Pictures that wait for touch: more would leave the decoder without places. */
const EARLY_MAX = 4;
const KEPT = 900;  // ages of drawn pictures, for whoever measures

export interface Shown { stamp: number; at: number; age: number }

/** What a camera asks of the page. */
export interface Around {
  /** [ms] of a stamp at that page time. */
  age(stamp: number, now: number): number;
  /** [ms] until touch is as old as a picture of that age; 0: it does not wait for pictures. */
  early(age: number): number;
  /** For a key frame. */
  ask(): void;
  /** A picture was drawn. */
  drew(now: number): void;
}

/** A decoded picture, which keeps its place in the decoder until it is closed. */
interface Decoded { width: number; height: number; source: CanvasImageSource; close(): void }

/** Of each NAL unit in Annex B: where its header stands. */
function* units(frame: Uint8Array): Generator<number> {
  for (let i = 0; i + 3 < frame.length; i++) {
    if (frame[i] === 0 && frame[i + 1] === 0 && frame[i + 2] === 1) yield i + 3;
  }
}

/** "avc1.42C01F" of a frame that brings its parameter set; undefined: it begins nothing. */
export function codecOf(frame: Uint8Array): string | undefined {
  for (const at of units(frame)) {
    const kind = frame[at]! & 31;
    if (kind === 7) return 'avc1.' + [1, 2, 3].map(i => frame[at + i]!.toString(16).padStart(2, '0')).join('').toUpperCase();
    if (kind === 1 || kind === 5) return undefined;
  }
  return undefined;
}

export class Camera {
  canvas: HTMLCanvasElement | undefined;
  shown: Shown | undefined;
  /** Why nothing can be shown, whatever comes; empty: it can. */
  fault = '';
  resets = 0;
  drawn: number[] = [];
  private decoder: VideoDecoder | undefined;
  private waiting: number[] = [];  // timestamps [us], the oldest first
  private askedAt = -1e9;
  private jpegUnderWay = false;

  constructor(private readonly around: Around) {}

  /** A frame as it came, H.264 in Annex B. */
  hear(frame: Uint8Array, stamp: number, now: number): void {
    if (typeof VideoDecoder === 'undefined') {
      this.fault = 'This browser decodes no video here (no WebCodecs). Start the patient’s site with --set camera.codec=jpeg.';
      return;
    }
    const codec = codecOf(frame);
    if (codec) this.begin(codec);
    if (!this.decoder) return this.askForKey(now);
    if (this.waiting.length >= WAITING_MAX || (this.waiting.length > 0 && now - this.heardAt > WAITING_AGE_MS)) return this.giveUp(now);
    if (this.waiting.length === 0) this.heardAt = now;
    const timestamp = Math.round(stamp * 1000);
    this.waiting.push(timestamp);
    this.decoder.decode(new EncodedVideoChunk({ type: codec ? 'key' : 'delta', timestamp, data: frame }));
  }
  private heardAt = 0;  // page time of the oldest that waits

  async hearJpeg(frame: Uint8Array, stamp: number): Promise<void> {
    if (this.jpegUnderWay) return;  // the newest wins
    this.jpegUnderWay = true;
    try {
      const picture = await createImageBitmap(new Blob([frame as BlobPart], { type: 'image/jpeg' }));
      this.show({ source: picture, width: picture.width, height: picture.height, close: () => picture.close() }, stamp);
    } catch { /* the next one may be whole */ }
    this.jpegUnderWay = false;
  }

  /** What was shown is of another session, or nobody looks. */
  end(): void {
    this.close();
    this.session++;
    this.shown = undefined;
  }

  private begin(codec: string): void {
    if (this.decoder && this.waiting.length === 0) return this.configure(this.decoder, codec);
    this.close();
    const decoder: VideoDecoder = new VideoDecoder({
      output: frame => {
        const at = this.decoder === decoder ? this.waiting.indexOf(frame.timestamp) : -1;
        this.heardAt = performance.now();
        if (at < 0) return frame.close();
        this.waiting.splice(0, at + 1);
        this.show({ source: frame, width: frame.displayWidth, height: frame.displayHeight, close: () => frame.close() }, frame.timestamp / 1000);
      },
      error: () => { if (this.decoder === decoder) this.giveUp(performance.now()); },
    });
    this.decoder = decoder;
    this.configure(decoder, codec);
  }

  private codec = '';
  private configure(decoder: VideoDecoder, codec: string): void {
    if (decoder.state === 'configured' && codec === this.codec) return;
    this.codec = codec;
    decoder.configure({ codec, optimizeForLatency: true });
  }

  private close(): void {
    if (this.decoder && this.decoder.state !== 'closed') this.decoder.close();
    this.decoder = undefined;
    this.waiting = [];
    this.codec = '';
  }

  private giveUp(now: number): void {
    this.resets++;
    this.close();
    this.askForKey(now);
  }

  private askForKey(now: number): void {
    if (now - this.askedAt < ASK_AGAIN_MS) return;
    this.askedAt = now;
    this.around.ask();
  }

  /** Draws it, now or when touch is as old. */
  private show(picture: Decoded, stamp: number): void {
    const session = this.session, early = this.kept < EARLY_MAX ? this.around.early(this.around.age(stamp, performance.now())) : 0;
    if (early < 1) return this.draw(picture, stamp);
    this.kept++;
    setTimeout(() => {
      this.kept--;
      if (this.session === session) this.draw(picture, stamp); else picture.close();
    }, early);
  }
  private kept = 0;     // pictures that wait for touch
  private session = 0;  // one more: what waits is of another

  private draw(picture: Decoded, stamp: number): void {
    const now = performance.now(), { source, width, height } = picture;
    if (this.shown && stamp < this.shown.stamp) return picture.close();
    this.paint(source, width, height);
    picture.close();
    this.shown = { stamp, at: now, age: this.around.age(stamp, now) };
    this.drawn.push(this.shown.age);
    if (this.drawn.length > KEPT) this.drawn.shift();
    this.around.drew(now);
  }

  private paint(source: CanvasImageSource, width: number, height: number): void {
    if (!this.canvas) return;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.canvas.getContext('2d', { alpha: false })!.drawImage(source, 0, 0);
  }
}

/** How far the picture lags behind touch, in words: people notice it from 15 ms on (Di Luca and
 *  Mahnan 2019), half of them at 45 ms (Vogels 2004); surgeons find 200 ms mild, 300 the most
 *  (Xu 2014). */
export function lagWords(ms: number): { text: string; tone: '' | 'ok' | 'warn' | 'bad' } {
  if (ms <= 15) return { text: 'in step', tone: 'ok' };
  if (ms <= 45) return { text: 'hardly noticed', tone: 'ok' };
  if (ms <= 200) return { text: 'noticed', tone: '' };
  if (ms <= 300) return { text: 'disturbs', tone: 'warn' };
  return { text: 'too far behind', tone: 'bad' };
}
