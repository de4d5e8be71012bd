/** Provide what happy-dom lacks: element sizes and canvases that record their texts. */
import { vi } from "vitest";
import { ticker } from "../src/drawing";

/** Size of every element, CSS pixels. */
export const WIDTH = 478;
export const HEIGHT = 180;

const written = new WeakMap<object, string[]>();

/** Redraw and return the texts on a canvas. */
export function readTexts(canvas: Element): string[] {
  ticker.drawNow();
  return written.get(canvas) ?? [];
}

/** Return a context that only records the texts written since the last clear. */
function createPen(canvas: object): object {
  const commands: Record<string, (...given: unknown[]) => unknown> = {
    clearRect: () => void written.set(canvas, []),
    fillText: (text) => void written.get(canvas)?.push(String(text)),
    measureText: (text) => ({ width: 6 * String(text).length }),
  };
  return new Proxy<Record<string, unknown>>(
    {},
    { get: (set, name: string) => set[name] ?? commands[name] ?? (() => null) },
  );
}

const pens = new WeakMap<object, object>();

function getContext(this: object): object {
  if (!pens.has(this)) pens.set(this, createPen(this));
  return pens.get(this)!;
}

class OffscreenCanvas {
  getContext = (): object => ({ fillStyle: "#000000" });
}

Object.assign(globalThis, { OffscreenCanvas });
Object.assign(HTMLCanvasElement.prototype, { getContext });
Object.assign(Element.prototype, {
  setPointerCapture: () => undefined,
  getBoundingClientRect: () => new DOMRect(0, 0, WIDTH, HEIGHT),
});

Object.defineProperty(HTMLElement.prototype, "clientWidth", { get: () => WIDTH });
Object.defineProperty(HTMLElement.prototype, "clientHeight", { get: () => HEIGHT });
Object.defineProperty(navigator, "locks", {
  value: { query: () => Promise.resolve({ held: [] }) },
});
vi.stubGlobal(
  "ResizeObserver",
  class {
    constructor(private readonly resized: () => void) {}
    observe = (): void => this.resized();
    disconnect = (): void => undefined;
  },
);
