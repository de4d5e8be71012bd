/** Tells the director when something changed, and turns what the user does into changes. */
import { effect } from "@preact/signals";
import { CLICK } from "../canvas/pointers";
import type { Store } from "../store";
import { theme } from "../theme";
import { ticker } from "../ticker";
import type { Director } from "./director";

const TURN = Math.PI / 24; // of one key press
const REST = 400; // milliseconds

/** Keeps the picture up to date; call the result to stop. */
export function direct(store: Store, director: Director, canvas: HTMLCanvasElement): () => void {
  const stale = { cast: true, paint: true, picture: true, edges: false };
  let resting: ReturnType<typeof setTimeout> | undefined;
  const expire = (...what: (keyof typeof stale)[]): void => {
    for (const each of what) stale[each] = true;
    ticker.request();
  };
  // What has stood still for a while is drawn once more, with all pixels.
  const sharpenSoon = (): void => {
    clearTimeout(resting);
    resting = setTimeout(() => expire("edges"), REST);
  };
  const onTurn = (): void => expire("picture");
  const resize = new ResizeObserver(() => {
    const { clientWidth, clientHeight } = canvas.parentElement!;
    director.stage.resize(clientWidth, clientHeight);
    expire("picture");
  });
  resize.observe(canvas.parentElement!);
  director.stage.controls.addEventListener("change", onTurn);
  const stops = [
    effect(() => {
      watchCast(store);
      expire("cast", "picture");
    }),
    effect(() => {
      void theme.value;
      expire("paint", "picture");
    }),
    effect(() => {
      watchPose(store);
      expire("picture");
    }),
    ticker.add((seconds) => {
      if (stale.cast) director.cast();
      if (stale.paint) director.paint();
      if (!store.active.value || (!stale.picture && !stale.edges)) return;
      const moving = stale.picture;
      if (moving) director.pose(seconds);
      stale.cast = stale.paint = stale.picture = stale.edges = false; // pose() turned the camera
      director.stage.draw(moving, seconds);
      if (moving) sharpenSoon();
    }),
    pickOnClick(store, director, canvas),
  ];
  return () => {
    for (const stop of stops) stop();
    resize.disconnect();
    clearTimeout(resting);
  };
}

/** Alt and an arrow key turn the camera as a drag would. */
export function turnByKey(event: KeyboardEvent, director: Director | null): void {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const turn = by[event.key as keyof typeof by];
  if (!event.altKey || !turn || !director) return;
  event.preventDefault();
  event.stopPropagation();
  director.stage.turn(TURN * turn[0]!, TURN * turn[1]!);
}

function watchCast(store: Store): void {
  for (const opened of store.opened.value) void opened.motion.value;
  void store.current.value;
  if (store.inStep.value) void store.shownCluster.value;
}

function watchPose(store: Store): void {
  void [store.playhead.value, store.primitives.value, store.selected.value];
  void [store.trails.value, store.follow.value];
}

/** A click on a member of a cluster selects it; on one of several recordings, shows it. */
function pickOnClick(store: Store, director: Director, canvas: HTMLCanvasElement): () => void {
  let from = { x: 0, y: 0 };
  const onDown = (event: PointerEvent): void => void (from = { x: event.x, y: event.y });
  const onClick = (event: MouseEvent): void => {
    if (Math.hypot(event.x - from.x, event.y - from.y) > CLICK) return;
    const box = canvas.getBoundingClientRect();
    const x = (2 * (event.x - box.left)) / box.width - 1;
    const y = 1 - (2 * (event.y - box.top)) / box.height;
    const actor = director.pick(x, y);
    if (actor?.segment) store.select(actor.segment);
    else if (actor && store.opened.value.length > 1) {
      const index = store.opened.value.findIndex((each) => each.motion.value === actor.motion);
      if (index >= 0 && index !== store.current.value) store.show(index);
    }
  };
  canvas.addEventListener("pointerdown", onDown);
  canvas.addEventListener("click", onClick);
  return () => {
    canvas.removeEventListener("pointerdown", onDown);
    canvas.removeEventListener("click", onClick);
  };
}
