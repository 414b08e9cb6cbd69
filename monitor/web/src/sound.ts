// Force as pitch: from 220 Hz at 0.02 N to 880 Hz at 2 N, and a click where the tissue begins.
const LEAST_N = 0.02, MOST_N = 2, LOW_HZ = 220, OCTAVES = 2;

export class Sound {
  private parts: { context: AudioContext; tone: OscillatorNode; gain: GainNode } | undefined;
  private touched = false;

  get on(): boolean { return this.parts !== undefined; }

  /** By a person's hand only: browsers allow it there. */
  toggle(): void {
    if (this.parts) {
      void this.parts.context.close();
      this.parts = undefined;
      return;
    }
    const context = new AudioContext({ latencyHint: 'interactive' });
    const tone = context.createOscillator(), gain = context.createGain();
    tone.type = 'triangle';
    gain.gain.value = 0;
    tone.connect(gain).connect(context.destination);
    tone.start();
    this.parts = { context, tone, gain };
  }

  play(force: number): void {
    if (!this.parts) return;
    const { context, tone, gain } = this.parts, now = context.currentTime, touches = force > LEAST_N;
    if (touches) {
      const share = Math.min(1, Math.log(force / LEAST_N) / Math.log(MOST_N / LEAST_N));
      tone.frequency.setTargetAtTime(LOW_HZ * 2 ** (OCTAVES * share), now, 0.01);
    }
    if (touches && !this.touched) gain.gain.setValueAtTime(0.3, now);
    gain.gain.setTargetAtTime(touches ? 0.12 : 0, now, 0.015);
    this.touched = touches;
  }
}
