/** Redraw the viewer when signals change and handle its input. */
import { effect } from "@preact/signals";
import { CLICK_TOLERANCE } from "../canvas/pointers";
import { listen } from "../util";
import type { Store } from "../store";
import { isPrinting, theme } from "../theme";
import { ticker } from "../ticker";
import type { FigureScene, Tag } from "./scene";
import type { Stage } from "./stage";

const TURN_STEP = Math.PI / 24; // radians per key press
const SETTLE_TIME = 400; // milliseconds

/** Keep the picture up to date; return a function that stops. */
export function startUpdates(
  store: Store,
  scene: FigureScene,
  canvas: HTMLCanvasElement,
): () => void {
  const tags = new NameTags(canvas.parentElement!);
  const stale = { figures: true, paint: true, picture: true, edges: false };
  let resting: ReturnType<typeof setTimeout> | undefined;
  const invalidate = (...what: (keyof typeof stale)[]): void => {
    for (const each of what) stale[each] = true;
    ticker.request();
  };
  // Redraw a static picture once in full resolution.
  const sharpenSoon = (): void => {
    clearTimeout(resting);
    resting = setTimeout(() => invalidate("edges"), SETTLE_TIME);
  };
  const onTurn = (): void => invalidate("picture");
  const resize = new ResizeObserver(() => {
    const { clientWidth, clientHeight } = canvas.parentElement!;
    scene.stage.resize(clientWidth, clientHeight);
    invalidate("picture");
  });
  resize.observe(canvas.parentElement!);
  scene.stage.controls.addEventListener("change", onTurn);
  const stops = [
    effect(() => {
      readFigureSignals(store);
      invalidate("figures", "picture");
    }),
    effect(() => {
      void theme.value;
      invalidate("paint", "picture");
    }),
    // The drawing buffer is cleared after display, so printing needs a new draw.
    effect(() => {
      void isPrinting.value;
      invalidate("edges");
    }),
    effect(() => {
      readPoseSignals(store);
      invalidate("picture");
    }),
    ticker.add((seconds) => {
      if (stale.figures) scene.populate();
      if (stale.paint) scene.setColors();
      if (!store.active.value || (!stale.picture && !stale.edges)) return;
      const moving = stale.picture;
      if (moving) scene.setPoses(seconds);
      // SetPoses() moves the camera, which sets `picture` again.
      stale.figures = stale.paint = stale.picture = stale.edges = false;
      scene.stage.draw(moving && !isPrinting.peek(), seconds);
      tags.show(scene.getNameTags());
      if (moving) sharpenSoon();
    }),
    pickOnClick(store, scene, canvas),
  ];
  return () => {
    for (const stop of stops) stop();
    resize.disconnect();
    tags.dispose();
    clearTimeout(resting);
  };
}

/** Turn the camera with Alt and an arrow key. */
export function turnByKey(event: KeyboardEvent, scene: { stage: Stage } | null): void {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const turn = by[event.key as keyof typeof by];
  if (!event.altKey || !turn || !scene) return;
  event.preventDefault();
  event.stopPropagation();
  scene.stage.orbit(TURN_STEP * turn[0]!, TURN_STEP * turn[1]!);
}

function readFigureSignals(store: Store): void {
  for (const opened of store.opened.value) void opened.motion.value;
  void store.current.value;
  if (store.inStep.value) void store.shownCluster.value;
}

function readPoseSignals(store: Store): void {
  void [store.playhead.value, store.primitives.value, store.selected.value];
  for (const { recording } of store.opened.value) void recording.value; // their colours are visible
  void [store.trails.value, store.follow.value, store.ghost.value];
}

/** Select the clicked member of a cluster, or activate the clicked recording. */
function pickOnClick(store: Store, scene: FigureScene, canvas: HTMLCanvasElement): () => void {
  let from = { x: 0, y: 0 };
  const onDown = (event: PointerEvent): void => void (from = { x: event.x, y: event.y });
  const onClick = (event: MouseEvent): void => {
    if (Math.hypot(event.x - from.x, event.y - from.y) > CLICK_TOLERANCE) return;
    const box = canvas.getBoundingClientRect();
    const x = (2 * (event.x - box.left)) / box.width - 1;
    const y = 1 - (2 * (event.y - box.top)) / box.height;
    const placed = scene.pick(x, y);
    if (placed?.segment) store.select(placed.segment);
    else if (placed && store.opened.value.length > 1) {
      const index = store.opened.value.findIndex((each) => each.motion.value === placed.motion);
      if (index >= 0 && index !== store.current.value) store.show(index);
    }
  };
  return listen(canvas, { pointerdown: onDown, click: onClick });
}

/** Show the names of several people above their heads. */
class NameTags {
  private readonly place = document.createElement("div");

  constructor(over: HTMLElement) {
    this.place.className = "name-tags";
    this.place.ariaHidden = "true"; // the caption also has them
    over.append(this.place);
  }

  show(tags: readonly Tag[]): void {
    const { place } = this;
    while (place.children.length > tags.length) place.lastChild!.remove();
    while (place.children.length < tags.length) place.append(document.createElement("span"));
    tags.forEach(({ name, x, y, isActive }, i) => {
      const tag = place.children[i] as HTMLElement;
      if (tag.textContent !== name) tag.textContent = name;
      tag.classList.toggle("front", isActive);
      tag.style.left = `${100 * x}%`;
      tag.style.top = `${100 * y}%`;
    });
  }

  dispose(): void {
    this.place.remove();
  }
}
