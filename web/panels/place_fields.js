const kHoldMs = 600;  // what the viewer has set is not overwritten by what the server still says

/** Three number fields for a place: they show where a thing is, and tell where it is wanted. */
export class PlaceFields {
  /** @param {HTMLElement} group holds three inputs with `data-axis` 0 to 2 @param {(position: number[]) => void} wanted */
  constructor(group, wanted) {
    this.inputs = [...group.querySelectorAll('input')];
    this.heldUntilMs = 0;
    group.addEventListener('change', () => {
      const values = this.inputs.map((input) => input.valueAsNumber);
      if (!values.every(Number.isFinite)) return;
      this.heldUntilMs = performance.now() + kHoldMs;
      wanted(values);
    });
  }

  enable(on) {
    for (const input of this.inputs) input.disabled = !on;
  }

  /** Another thing is shown: what was set is not waited for. */
  release() {
    this.heldUntilMs = 0;
  }

  /** A field being typed in is left alone, and so are all until the server had time to move the thing. @param {number[]|undefined} position m */
  show(position) {
    if (performance.now() < this.heldUntilMs) return;
    for (const input of this.inputs) {
      const text = position ? position[Number(input.dataset.axis)].toFixed(2) : '';
      if (input !== document.activeElement && input.value !== text) input.value = text;
    }
  }
}
