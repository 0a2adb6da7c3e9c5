const kTypes = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];  // Safari has the last alone
const kFramesPerSecond = 30;
const kBitsPerSecond = 8e6;
const kLongestMs = 120_000;  // it is kept in memory: 120 MB

/** Records what the canvas shows. */
export class Video {
  #recorder = null;
  #timer = null;
  #startMs = 0;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(video: Blob, ending: string) => void} done called with each video when it ends, however that is
   */
  constructor(canvas, done) {
    this.canvas = canvas;
    this.done = done;
  }

  /** Whether the browser can. */
  get possible() {
    return typeof this.canvas.captureStream === 'function' && typeof MediaRecorder === 'function' && kTypes.some((type) => MediaRecorder.isTypeSupported(type));
  }

  get recording() {
    return this.#recorder !== null;
  }

  /** Seconds recorded so far. */
  get seconds() {
    return this.recording ? (performance.now() - this.#startMs) / 1000 : 0;
  }

  start() {
    if (this.recording) return;
    const mimeType = kTypes.find((type) => MediaRecorder.isTypeSupported(type));
    const stream = this.canvas.captureStream(kFramesPerSecond);
    const recorder = new MediaRecorder(stream, {mimeType, videoBitsPerSecond: kBitsPerSecond});
    const parts = [];
    recorder.addEventListener('dataavailable', ({data}) => parts.push(data));
    recorder.addEventListener('stop', () => {
      for (const track of stream.getTracks()) track.stop();
      const [type] = mimeType.split(';');
      this.done(new Blob(parts, {type}), type.split('/')[1]);
    });
    recorder.start();
    this.#recorder = recorder;
    this.#startMs = performance.now();
    this.#timer = setTimeout(() => this.stop(), kLongestMs);
  }

  stop() {
    clearTimeout(this.#timer);
    const recorder = this.#recorder;
    this.#recorder = null;
    if (recorder?.state === 'recording') recorder.stop();
  }
}
