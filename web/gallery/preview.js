import {WeftClient} from '../protocol/weft.js';

const kFrameMs = 66;  // between two frames: an acknowledgement that waits keeps the server from sending more
const kBeyond = 2;    // times the farthest threshold: there the scene is at its coarsest

/** The stream of one card: the scene at its coarsest level, a few times a second. */
export class Preview {
  #client;

  /**
   * @param {string} server @param {string} scene @param {string|null} token
   * @param {{begin: (message: object) => void, surface: (obstacle: number, surface: object) => void, frame: (frame: object) => void,
   *   ended: () => void}} on `ended`: the connection was refused or lost
   */
  constructor(server, scene, token, on) {
    this.ended = false;
    const end = () => {
      if (this.ended) return;
      this.ended = true;
      on.ended();
    };
    this.#client = new WeftClient(`${server}/v1/scenes/${encodeURIComponent(scene)}`, {
      client: 'weft gallery',
      token: token ?? undefined,
      window: 1,
      local: true,
      onmessage: (message) => {
        if (this.ended || message.op !== 'scene') return;
        on.begin(message);
        // The farthest is for this viewer alone: what others see stays as fine as it is.
        this.#client.camera({distance: kBeyond * Math.max(1, ...message.level_policy.thresholds)}).catch(() => {});
        this.#fetchSurfaces(message, on);
      },
      onframe: (frame) => {
        if (this.ended) return;
        on.frame(frame);
        return new Promise((resolve) => setTimeout(resolve, kFrameMs));
      },
      onstate: (state) => state === 'closed' && end(),
    });
    this.#client.open().catch(end);
  }

  /** Nothing is received any more. */
  close() {
    this.ended = true;
    this.#client.close();
  }

  async #fetchSurfaces({obstacles = []}, on) {
    for (const [obstacle, {shape}] of obstacles.entries()) {
      if (shape !== 'mesh' && shape !== 'convex') continue;
      const surface = await this.#client.surface(obstacle).catch(() => null);
      if (this.ended) return;
      if (surface) on.surface(obstacle, surface);
    }
  }
}
