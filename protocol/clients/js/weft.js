/**
 * Weft client: the protocol of PROTOCOL.md (weft.v1) for pages, workers and Node.
 *
 *   import { connect } from 'weft-client';
 *   const scene = await connect('ws://127.0.0.1:8080/v1/scenes/flag', { onframe: (frame) => draw(frame) });
 *   await scene.camera({ distance: 5 });
 *   const ball = await scene.addBall([0, 1, 2], 0.2);
 *   await scene.throwBall(ball, [0, 0, -6]);
 *   scene.close();
 */
export { connect, WeftClient } from './client.js';
export { Commands } from './commands.js';
export { WeftError } from './errors.js';
export { glbBytes, objText } from './export.js';
export { decodeFrame } from './frames.js';
export { messageText } from './messages.js';
export { backoff, bearer, SUBPROTOCOL } from './transport.js';
export * from './types.js';
