/** Show the figures in 3-D. */
import { useEffect, useRef } from "preact/hooks";
import { useStore, type Store } from "../store";
import { startUpdates, turnByKey } from "./updates";
import { FigureScene } from "./scene";
import { Button, Swatch, Toggle } from "../layout/controls";
import { NO_COLOR } from "../colors";
import { formatCount } from "../util";
import { formatPerson, type OpenRecording } from "../recordingData";
import { getSegmentName, findPrimitiveAt } from "../segments";
import { formatTime } from "../view";
import { MAX_MEMBERS } from "./placement";

export function Viewer() {
  const store = useStore();
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<FigureScene | null>(null);
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
          <Swatch color={store.getColor(present) ?? NO_COLOR} /> {getSegmentName(present)}
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
      <Swatch color={(present && store.getColor(present)) ?? NO_COLOR} />{" "}
      {opened === store.active.value ? <strong>{called}</strong> : called}{" "}
      <span class="quiet">{present && getSegmentName(present)}</span>
    </p>
  );
}
