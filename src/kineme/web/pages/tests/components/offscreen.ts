/** A canvas that is never shown, which happy-dom has not; imported before all else. */
class OffscreenCanvas {
  getContext = (): object => ({ fillStyle: "#000000" });
}

Object.assign(globalThis, { OffscreenCanvas });
export {};
