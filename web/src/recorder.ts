// A video of the view, written by the browser itself.

const KINDS: [string, string][] = [
  ["video/webm;codecs=vp9", "webm"],
  ["video/webm;codecs=vp8", "webm"],
  ["video/webm", "webm"],
  ["video/mp4", "mp4"],
];
const RATE = 30; // pictures a second
const BITS_PER_SECOND = 12e6;
const LONGEST = 600; // [s]: a video is kept in memory until it is saved

export interface RecorderListener {
  /** Requests a drawing: an unchanged canvas gives no frames. */
  draw(): void;
  /** Called during the recording with its length so far [s], and with null at its end. */
  tick(seconds: number | null): void;
  done(video: Blob, extension: string): void;
  failed(why: string): void;
}

/** The format that this browser can write; null: none. */
export function videoKind(): { mime: string; extension: string } | null {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in HTMLCanvasElement.prototype)) return null;
  const kind = KINDS.find(([mime]) => MediaRecorder.isTypeSupported(mime));
  return kind ? { mime: kind[0], extension: kind[1] } : null;
}

export class Recorder {
  private recorder: MediaRecorder | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly listener: RecorderListener) {}

  get running(): boolean {
    return this.recorder !== null;
  }

  start(): void {
    const kind = videoKind();
    if (!kind) return this.listener.failed("This browser cannot write a video");
    const parts: Blob[] = [];
    let recorder: MediaRecorder;
    try {
      recorder = new MediaRecorder(this.canvas.captureStream(RATE), { mimeType: kind.mime, videoBitsPerSecond: BITS_PER_SECOND });
      recorder.start(1000);
    } catch (error) {
      return this.listener.failed(`The video could not be begun: ${error instanceof Error ? error.message : error}`);
    }
    this.recorder = recorder;
    recorder.ondataavailable = (event) => event.data.size > 0 && parts.push(event.data);
    recorder.onerror = () => this.listener.failed("The browser has ended the video");
    recorder.onstop = () => {
      clearInterval(this.timer);
      this.recorder = null;
      for (const track of recorder.stream.getTracks()) track.stop();
      this.listener.tick(null);
      if (parts.length > 0) this.listener.done(new Blob(parts, { type: kind.mime }), kind.extension);
    };
    const began = performance.now();
    this.listener.tick(0);
    this.timer = setInterval(() => {
      const seconds = (performance.now() - began) / 1000;
      this.listener.draw();
      this.listener.tick(seconds);
      if (seconds > LONGEST) this.stop();
    }, 1000 / RATE);
  }

  stop(): void {
    if (this.recorder?.state === "recording") this.recorder.stop();
  }
}
