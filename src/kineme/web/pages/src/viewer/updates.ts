/** Draws anew when something changed, and turns what the user does into changes. */
import { effect } from "@preact/signals";
import { CLICK } from "../canvas/pointers";
import type { Store } from "../store";
import { onPaper, theme } from "../theme";
import { ticker } from "../ticker";
import { NameTags } from "./nameTags";
import type { FigureScene } from "./scene";
import type { Stage } from "./stage";

const TURN = Math.PI / 24; // of one key press
const REST = 400; // milliseconds

/** Keeps the picture up to date; call the result to stop. */
export function keepUpToDate(
  store: Store,
  scene: FigureScene,
  canvas: HTMLCanvasElement,
): () => void {
  const tags = new NameTags(canvas.parentElement!);
  const stale = { figures: true, paint: true, picture: true, edges: false };
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
    scene.stage.resize(clientWidth, clientHeight);
    expire("picture");
  });
  resize.observe(canvas.parentElement!);
  scene.stage.controls.addEventListener("change", onTurn);
  const stops = [
    effect(() => {
      watchFigures(store);
      expire("figures", "picture");
    }),
    effect(() => {
      void theme.value;
      expire("paint", "picture");
    }),
    // What was drawn into is empty once it has been shown: whoever reads it has it drawn before.
    effect(() => {
      void onPaper.value;
      expire("edges");
    }),
    effect(() => {
      watchPose(store);
      expire("picture");
    }),
    ticker.add((seconds) => {
      if (stale.figures) scene.populate();
      if (stale.paint) scene.paint();
      if (!store.active.value || (!stale.picture && !stale.edges)) return;
      const moving = stale.picture;
      if (moving) scene.pose(seconds);
      stale.figures = stale.paint = stale.picture = stale.edges = false; // pose() turned the camera
      scene.stage.draw(moving && !onPaper.peek(), seconds);
      tags.show(scene.tags());
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

/** Alt and an arrow key turn the camera as a drag would. */
export function turnByKey(event: KeyboardEvent, scene: { stage: Stage } | null): void {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const turn = by[event.key as keyof typeof by];
  if (!event.altKey || !turn || !scene) return;
  event.preventDefault();
  event.stopPropagation();
  scene.stage.turn(TURN * turn[0]!, TURN * turn[1]!);
}

function watchFigures(store: Store): void {
  for (const opened of store.opened.value) void opened.motion.value;
  void store.current.value;
  if (store.inStep.value) void store.shownCluster.value;
}

function watchPose(store: Store): void {
  void [store.playhead.value, store.primitives.value, store.selected.value];
  for (const { recording } of store.opened.value) void recording.value; // whose colours are seen
  void [store.trails.value, store.follow.value, store.ghost.value];
}

/** A click on a member of a cluster selects it; on one of several recordings, shows it. */
function pickOnClick(store: Store, scene: FigureScene, canvas: HTMLCanvasElement): () => void {
  let from = { x: 0, y: 0 };
  const onDown = (event: PointerEvent): void => void (from = { x: event.x, y: event.y });
  const onClick = (event: MouseEvent): void => {
    if (Math.hypot(event.x - from.x, event.y - from.y) > CLICK) return;
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
  canvas.addEventListener("pointerdown", onDown);
  canvas.addEventListener("click", onClick);
  return () => {
    canvas.removeEventListener("pointerdown", onDown);
    canvas.removeEventListener("click", onClick);
  };
}
