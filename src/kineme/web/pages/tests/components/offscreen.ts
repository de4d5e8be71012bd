/** Provide OffscreenCanvas, which happy-dom lacks; import this file first. */
class OffscreenCanvas {
  getContext = (): object => ({ fillStyle: "#000000" });
}

Object.assign(globalThis, { OffscreenCanvas });
export {};
