/** Show the figures in 3-D: redraw when signals change and handle pointers and keys. */
import { useEffect, useRef } from "preact/hooks";
import { useStore, type Store } from "../store";
import { FigureScene, type Tag } from "./scene";
import { Button, Swatch, Toggle } from "../layout/controls";
import { formatCount } from "../util";
import { formatPerson, type OpenRecording } from "../recordingData";
import { findPrimitiveAt, getSegmentName } from "../segments";
import { formatTime } from "../view";
import { MAX_MEMBERS, type PlacedFigure } from "./placement";
import { effect } from "@preact/signals";
import { CLICK_TOLERANCE, isPrinting, theme, ticker } from "../drawing";
import type { Stage } from "./stage";

export function Viewer() {
  const store = useStore();
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<FigureScene | null>(null);
  const pressed = useRef({ x: 0, y: 0 });
  useEffect(() => {
    const element = canvas.current!;
    const made = new FigureScene(store, element);
    scene.current = made;
    const stop = startUpdates(store, made, element);
    return () => {
      stop();
      made.dispose();
    };
  }, [store]);
  return (
    <div class="viewer" inert={!store.active.value}>
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label="Figure in 3-D. Drag or press alt and an arrow key to look from another side."
        onKeyDown={(event) => turnByKey(event, scene.current)}
        onPointerDown={({ x, y }) => (pressed.current = { x, y })}
        onClick={(event) => {
          const { x, y } = pressed.current;
          if (Math.hypot(event.x - x, event.y - y) > CLICK_TOLERANCE) return;
          const box = event.currentTarget.getBoundingClientRect();
          pickFigure(
            store,
            scene.current?.pick(
              (2 * (event.x - box.left)) / box.width - 1,
              1 - (2 * (event.y - box.top)) / box.height,
            ),
          );
        }}
      />
      <Caption />
      <ViewerButtons onFrame={() => scene.current?.frameFigures()} />
    </div>
  );
}

/** Offer the viewer's options. */
function ViewerButtons({ onFrame }: { onFrame: () => void }) {
  const store = useStore();
  const hasMotion = Boolean(store.active.value?.motion.value);
  return (
    <div class="viewer-buttons">
      <Toggle on={store.follow} title="The camera follows the figure">
        Follow
      </Toggle>
      <Toggle on={store.trails} title="The last paths of hands and feet">
        Trails
      </Toggle>
      <Toggle
        on={store.inStep}
        title="All members of the selected cluster, playing in step"
        disabled={store.clusters.value.length === 0 || !hasMotion}
        onClick={() => {
          if (store.cluster.value === null) store.selectCluster(getCurrentCluster(store));
          store.inStep.value = !store.inStep.value;
        }}
      >
        In step
      </Toggle>
      <Button
        aria-pressed={store.ghost.value !== null}
        title="Keep the repetition at the playhead as a ghost, and lay it over the others (V)"
        disabled={!store.present.value || !hasMotion}
        onClick={() => store.toggleGhost()}
      >
        Ghost
      </Button>
      <Button onClick={onFrame} title="Put the camera where everything is seen">
        Reset view
      </Button>
    </div>
  );
}

/** Return the cluster at the playhead, else the first. */
function getCurrentCluster(store: Store): number {
  const present = store.present.value?.cluster ?? -1;
  return present >= 0 ? present : (store.clusters.value[0]?.id ?? 0);
}

/** Describe what is played, over the picture. */
export function Caption() {
  const store = useStore();
  const present = store.present.value;
  const shown = store.shownCluster.value;
  const stepping = store.inStep.value && shown;
  const people = stepping ? [] : store.people.value;
  const n = shown?.members.length ?? 0;
  const all = formatCount(n, "member");
  const count = n > MAX_MEMBERS ? `the first ${MAX_MEMBERS} of ${n} members` : all;
  return (
    <div class="caption">
      {people.map((each) => (
        <PersonCaption key={each.recording.value.id} opened={each} />
      ))}
      {present && !people.length && (
        <p>
          <Swatch color={store.getColor(present)} /> {getSegmentName(present)}
        </p>
      )}
      {store.ghost.value && !stepping && (
        <p class="quiet">
          ghost: {getSegmentName(store.ghost.value)} of {formatTime(store.ghost.value.start_s, 2)}
        </p>
      )}
      {stepping && <p class="quiet">{count} in step</p>}
      {!stepping && store.opened.value.length > Math.max(people.length, 1) && (
        <p class="quiet">
          {store.opened.value.map((each) => each.recording.value.name).join(" · ")}
        </p>
      )}
    </div>
  );
}

/** Show the primitive of one of several people; the active one's name is bold. */
function PersonCaption({ opened }: { opened: OpenRecording }) {
  const store = useStore();
  const { person, name, segmentation } = opened.recording.value;
  const present = findPrimitiveAt(segmentation, store.playhead.value);
  const called = formatPerson(person ?? name);
  return (
    <p>
      <Swatch color={present && store.getColor(present)} />{" "}
      {opened === store.active.value ? <strong>{called}</strong> : called}{" "}
      <span class="quiet">{present && getSegmentName(present)}</span>
    </p>
  );
}

const TURN_STEP = Math.PI / 24; // radians per key press
const SETTLE_TIME = 400; // milliseconds

/** Keep the picture up to date; return a function that stops. */
function startUpdates(store: Store, scene: FigureScene, canvas: HTMLCanvasElement): () => void {
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
      if (stale.paint) scene.stage.setColors();
      if (!store.active.value || (!stale.picture && !stale.edges)) return;
      const moving = stale.picture;
      if (moving) scene.setPoses(seconds);
      // SetPoses() moves the camera, which sets `picture` again.
      stale.figures = stale.paint = stale.picture = stale.edges = false;
      scene.stage.draw(moving && !isPrinting.peek(), seconds);
      tags.show(scene.getNameTags());
      if (moving) sharpenSoon();
    }),
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

/** Select the member of a cluster that a figure shows, or activate its recording. */
function pickFigure(store: Store, placed: PlacedFigure | undefined): void {
  if (!placed) return;
  if (placed.segment) return store.select(placed.segment);
  const index = store.opened.value.findIndex((each) => each.motion.value === placed.motion);
  if (index >= 0 && index !== store.current.value) store.show(index);
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
