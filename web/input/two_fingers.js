/**
 * Two fingers that come down together move the camera, whatever the first of them came down on: the hand that took something with it
 * gives it to the camera, which has not heard of it.
 */

const kTogetherMs = 300;
const handedOver = new WeakSet();

/** Whether `event` is the second finger of two that came together. @param {PointerEvent} event @param {{pressed: PointerEvent}} held */
export const meansCamera = (event, {pressed}) =>
  event.pointerType === 'touch' && pressed.pointerType === 'touch' && event.timeStamp - pressed.timeStamp < kTogetherMs;

/** Presses the canvas once more by the first finger; hands leave that press alone. @param {PointerEvent} pressed */
export function handOver(canvas, pressed) {
  const {pointerId, pointerType, isPrimary, button, buttons, clientX, clientY, screenX, screenY} = pressed;
  const event = new PointerEvent('pointerdown', {
    bubbles: true, cancelable: true, pointerId, pointerType, isPrimary, button, buttons, clientX, clientY, screenX, screenY,
  });
  handedOver.add(event);
  canvas.dispatchEvent(event);
}

/** @param {Event} event */
export const isHandedOver = (event) => handedOver.has(event);
